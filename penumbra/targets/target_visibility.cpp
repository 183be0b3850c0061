// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <penumbra/targets/target_visibility.hpp>

namespace penumbra {
namespace {

/// Accuracy of masks, pixels: networks produce them at a quarter of the image's size.
constexpr int mask_error = 4;

/// Rounding of widths and heights, pixels.
constexpr int rounding = 1;

/// By which a remembered extent is scaled at most, to stay within integers.
constexpr double largest_scale = 100.0;

bool is_out_of_view(const Visibility& visibility, const TargetThresholds& thresholds) {
  return static_cast<double>(visibility.inside) <=
         thresholds.min_inside * static_cast<double>(visibility.covered);
}

Verdict next_level(Verdict level, double hidden, const TargetThresholds& t) {
  if (hidden > (level == Verdict::hidden ? t.hidden_leave : t.hidden_enter)) return Verdict::hidden;
  if (hidden > (level == Verdict::visible ? t.partial_enter : t.partial_leave))
    return Verdict::partial;
  return Verdict::visible;
}

/// Returns whether enough was seen for the verdicts visible and partial.
bool is_seen_enough(const Visibility& visibility, Verdict level, const TargetThresholds& t) {
  if (level == Verdict::hidden) return true;
  const std::size_t least = level == Verdict::visible ? visibility.pixels[PixelState::unknown] : 0;
  if (visibility.seen() <= least) return false;
  return !visibility.is_expected ||
         !(visibility.is_passed(t.past_limit) || visibility.is_unmeasured(t.min_measured));
}

Verdict decide(const Visibility& visibility, const TargetThresholds& thresholds,
               TargetMemory& memory) {
  if (visibility.inside < visibility.needed) return Verdict::unknown;
  if (is_out_of_view(visibility, thresholds)) return Verdict::out_of_view;
  if (!visibility.has_pose) return Verdict::unknown;
  const double hidden = visibility.hidden(thresholds.others_hide);
  const double unknown =
      visibility.has_whole ? visibility.fraction(PixelState::unknown) : 1 - hidden;
  // Missing pixels are not seen: unknown_limit does not apply then.
  const bool is_uncertain = !visibility.has_whole || visibility.is_missing;
  const double limit =
      is_uncertain ? 0 : thresholds.unknown_limit.value_or(thresholds.partial_enter);
  const Verdict level = next_level(memory.level, hidden, thresholds);
  if (unknown > limit && next_level(memory.level, hidden + unknown, thresholds) != level)
    return Verdict::unknown;
  if (!is_seen_enough(visibility, level, thresholds)) return Verdict::unknown;
  memory.level = level;
  return level;
}

std::string reason_for_unknown(const Visibility& visibility, const LabelledImages& images,
                               const TargetThresholds& thresholds) {
  if (!images.fault.empty()) return images.fault;
  if (visibility.inside < visibility.needed)
    return std::to_string(visibility.inside) + " measured rays of the scan meet it";
  if (!visibility.has_pose) return "the robot's pose is not known in this frame";
  if (!visibility.has_whole)
    return "it was not seen whole away from the robot: how much of it the robot hides is not "
           "known; give its expected_depth or height, or the full extent as amodal";
  if (visibility.is_missing)
    return "its mask is smaller than the whole target, and the robot is next to it";
  if (visibility.is_expected && visibility.is_passed(thresholds.past_limit))
    return "the sensor looks past where most of it is expected: it is absent or transparent, or "
           "its expected depth is wrong";
  if (visibility.is_expected && visibility.is_unmeasured(thresholds.min_measured))
    return "hardly anything is measured where it is expected; min_measured: 0 allows that";
  if (visibility.is_uncovered) return "too much of it lies where the lens model does not reach";
  const bool is_assumed = images.evidence == Evidence::assumed_free;
  if (visibility.is_expected)
    return is_assumed ? "too much of it is at the robot's own depth"
                      : "too much of it is robot without measurement, at the robot's own depth or "
                        "at its outline";
  return is_assumed
             ? "the robot is before or behind it: give its expected_depth, or its height"
             : "too much of it is robot without measurement; give expected_depth, or its height";
}

Eigen::Array2d first_of(const PixelRectangle& box) { return {box.u0, box.v0}; }
Eigen::Array2d end_of(const PixelRectangle& box) { return {box.u1, box.v1}; }
Eigen::Array2d size_of(const PixelRectangle& box) { return end_of(box) - first_of(box); }

/// Returns whether robot that may hide the target lies in a box, which is clipped to the image.
bool holds_robot(const TargetInFrame& at, const PixelRectangle& box) {
  const TalliedFrame& frame = at.frame;
  const auto& depth = at.expected.constant;
  const float far = depth ? LimitRule(*frame.rule, at.expected.margin).at(*depth).far
                          : std::numeric_limits<float>::infinity();
  if (!frame.robot_may_lie_in(box)) return false;
  const auto [u0, v0, u1, v1] = overlap(box, frame.image());
  for (int v = v0; v < v1; ++v)
    if (frame.robot_lies_in({v, u0, u1}, far)) return true;
  return false;
}

/// Returns the factor from a remembered extent to its size at the target's depth; 1 if a depth is
/// unknown.
double scale_of(const TargetMemory& memory, const TargetView& target) {
  if (!memory.depth || !target.expected_depth) return 1.0;
  return std::clamp(*memory.depth / *target.expected_depth, 1 / largest_scale, largest_scale);
}

/// Returns whether a size exceeds that of the whole object in a direction, so that it is another's.
bool outgrows(const Eigen::Array2d& size, const Eigen::Array2d& whole, const TargetThresholds& t) {
  return (size > (1 + 0.5 * t.partial_enter) * whole + rounding).any();
}

/// Returns whether a size lacks more in one direction than in the other, so that something covers
/// the object. One that moves away shrinks in both.
bool is_covered(const Eigen::Array2d& size, const Eigen::Array2d& whole,
                const TargetThresholds& t) {
  const Eigen::Array2d ratio = size / whole;
  return !outgrows(size, whole, t) &&
         ratio.maxCoeff() - ratio.minCoeff() > 2 * mask_error / whole.minCoeff();
}

}  // namespace

Visibility::Visibility(const ExtentTally& tally, Evidence evidence, std::size_t all,
                       std::size_t in_image, bool is_depth_known)
    : covered(all),
      inside(in_image),
      pixels(tally.pixels),
      measured(tally.measured),
      past(tally.past),
      is_expected(is_depth_known),
      links(&tally.links) {
  if (evidence == Evidence::measured) unmeasured = seen() - measured;
  if (evidence == Evidence::none) mark_all_unknown();
}

double Visibility::share(std::size_t count) const {
  return inside == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(inside);
}

double Visibility::fraction(PixelState state) const { return share(pixels[state]); }

void Visibility::mark_unknown(PixelState state, std::size_t& count) {
  const std::size_t some = std::min(count, pixels[state]);
  pixels[state] -= some;
  pixels[PixelState::unknown] += some;
  count -= some;
}

void Visibility::mark_all_unknown() {
  pixels[PixelState::unknown] += seen();
  pixels[PixelState::clear] = pixels[PixelState::front] = 0;
  measured = past = 0;
}

Visibility ExtentObserver::observe_extent(const TargetInFrame& at, const RegionSpans& extent,
                                          RobotSurroundings* robot, ExtentTally& tally) {
  tally_extent(at.frame, extent.spans(), at.expected, at.target.thresholds.beyond_hides, robot,
               tally);
  return {tally, at.frame.images.evidence, extent.covered(), extent.inside(), at.expected.known()};
}

std::optional<double> ExtentObserver::depth_by_height(const TargetInFrame& at,
                                                      const TargetMemory& memory,
                                                      double focal) const {
  if (seen_.spans().empty() || !at.frame.has_pose()) return memory.depth;
  const PixelRectangle box = box_of_spans(seen_.spans());
  if (at.target.extent == Extent::modal) {
    // As in observe_modal, which judges what is near the robot by the whole extent alone.
    Eigen::Array2d around(at.reach(), at.reach());
    if (!memory.whole.empty())
      around = 2 * around + (size_of(box_of_spans(memory.whole)) - size_of(box)).max(0);
    const PixelRectangle near =
        grown(box, static_cast<int>(around.x()), static_cast<int>(around.y()));
    if (reaches_border() || holds_robot(at, near)) return memory.depth;
  }
  const auto* const exact = std::get_if<PixelBox>(&at.target.region);
  return focal * *at.target.height / (exact != nullptr ? exact->height : size_of(box).y());
}

Visibility ExtentObserver::observe(const TargetInFrame& at, TargetMemory& memory) {
  if (!at.frame.has_pose()) {
    seen_tally_.clear();
    seen_tally_.pixels[PixelState::unknown] = seen_.inside();
    Visibility none(seen_tally_, Evidence::none, seen_.covered(), seen_.inside(), false);
    none.has_pose = false;
    return none;
  }
  const Visibility now =
      observe_extent(at, seen_, at.wants_depths ? &at.robot : nullptr, seen_tally_);
  return at.target.extent == Extent::modal ? observe_modal(at, memory, now) : now;
}

/// What is missing of the last whole extent is unknown where the robot may hide it.
Visibility ExtentObserver::observe_modal(const TargetInFrame& at, TargetMemory& memory,
                                         const Visibility& now) {
  is_near_robot_ = false;
  if (is_out_of_view(now, at.target.thresholds)) return now;
  const PixelRectangle box = box_of_spans(seen_.spans());
  const bool is_there = place_whole(at, memory, box);
  // Masks may keep away from what hides their targets, and shrink before it touches them.
  const int reach = memory.whole.empty() ? at.reach() : 2 * at.reach();
  const Eigen::Array2d around = (whole_size_ - size_of(box)).max(0) + reach;
  is_near_robot_ =
      holds_robot(at, grown(box, static_cast<int>(around.x()), static_cast<int>(around.y())));
  const bool is_other = outgrows(size_of(box), whole_size_, at.target.thresholds);
  if (is_near_robot_ ? is_other : !is_there) memory.whole.clear();
  if (!is_near_robot_) return now;
  if (is_other || !is_there || reaches_border()) {
    Visibility part = now;
    part.has_whole = false;
    return part;
  }
  const auto whole = static_cast<double>(whole_.covered());
  // What it exceeds the extent in one direction does not make up for what lacks in the other.
  const double excess = (size_of(box) / whole_size_).max(1).prod();
  const double missing = whole - static_cast<double>(now.inside) / excess;
  if (missing <= at.target.thresholds.partial_enter * whole) return now;
  return observe_whole(at, static_cast<std::size_t>(missing));
}

/// Scales the last whole extent to the target's depth, moves it by the target's track, and then as
/// little as lets it hold what is seen. Returns whether anything is seen where it is expected.
bool ExtentObserver::place_whole(const TargetInFrame& at, const TargetMemory& memory,
                                 const PixelRectangle& box) {
  whole_size_.setZero();
  if (memory.whole.empty()) return false;
  const PixelRectangle last = box_of_spans(memory.whole);
  const double scale = scale_of(memory, at.target);
  whole_size_ = scale * size_of(last);
  moved_ = memory.moved + at.target.motion.value_or(Eigen::Vector2d::Zero());
  const Eigen::Array2d expected =
      first_of(last) + 0.5 * (size_of(last) - whole_size_) + moved_.array();
  const Eigen::Array2d a = first_of(box), b = end_of(box) - whole_size_;
  const Eigen::Array2d first = expected.max(a.min(b)).min(a.max(b));
  moved_ += (first - expected).matrix();
  whole_.fill_scaled(memory.whole, scale, first - scale * first_of(last));
  whole_.keep(seen_pixels_);
  return (expected - mask_error <= end_of(box)).all() &&
         (expected + whole_size_ + mask_error >= first_of(box)).all();
}

Visibility ExtentObserver::observe_whole(const TargetInFrame& at, std::size_t missing) {
  Visibility whole = observe_extent(at, whole_, nullptr, whole_tally_);
  const StateCounts& pixels = whole.pixels;
  const std::size_t known =
      pixels[PixelState::occluded] + pixels[PixelState::other] + pixels[PixelState::unknown];
  std::size_t uncertain = missing - std::min(missing, known);
  whole.is_missing = true;
  whole.mark_unknown(PixelState::clear, uncertain);
  whole.mark_unknown(PixelState::front, uncertain);
  return whole;
}

bool ExtentObserver::reaches_border() const {
  const std::span<const RowSpan> spans = seen_.spans();
  return std::any_of(spans.begin(), spans.end(), [&](const RowSpan& span) {
    for (const int dv : {-mask_error, 0, mask_error}) {
      const RowSpan around{span.v + dv, span.u0 - mask_error, span.u1 + mask_error};
      if (!seen_pixels_.hold(around, width_, height_)) return true;
    }
    return false;
  });
}

void ExtentObserver::remember(const TargetView& target, TargetMemory& memory) const {
  const bool has_whole = !memory.whole.empty();
  const Eigen::Array2d size = size_of(box_of_spans(seen_.spans()));
  if (has_whole) memory.moved = moved_;
  if (is_near_robot_ || reaches_border()) return;
  if (has_whole && is_covered(size, whole_size_, target.thresholds)) return;
  memory.whole.assign(seen_.spans().begin(), seen_.spans().end());
  memory.depth = target.expected_depth;
  memory.moved.setZero();
}

Judgement Visibility::judge(const LabelledImages& images, const TargetThresholds& thresholds,
                            TargetMemory& memory) const {
  Judgement judgement;
  judgement.verdict = decide(*this, thresholds, memory);
  if (judgement.verdict == Verdict::unknown)
    judgement.reason = reason_for_unknown(*this, images, thresholds);
  judgement.covered = covered;
  judgement.inside = inside;
  judgement.occluded = fraction(PixelState::occluded);
  judgement.front = fraction(PixelState::front);
  judgement.unknown = fraction(PixelState::unknown);
  judgement.clear = fraction(PixelState::clear);
  judgement.blame = links->blame(inside, images.link_names);
  if (images.evidence != Evidence::measured || !has_pose) return judgement;
  judgement.measured = share(measured);
  if (!is_expected) return judgement;
  judgement.hidden_by_other = fraction(PixelState::other);
  judgement.seen_past = share(past);
  return judgement;
}

void distrust(const LabelledImages& images, Judgement& judgement) {
  if (images.undrawn.empty()) return;
  judgement.unknown += judgement.clear + judgement.front;
  judgement.clear = judgement.front = 0.0;
  judgement.measured.reset();
  judgement.seen_past.reset();
  if (judgement.verdict != Verdict::visible && judgement.verdict != Verdict::partial) return;
  judgement.verdict = Verdict::unknown;
  judgement.reason = images.undrawn;
}

}  // namespace penumbra
