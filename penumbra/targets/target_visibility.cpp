// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <penumbra/targets/target_visibility-inl.hpp>

namespace penumbra {
namespace {

/// Accuracy of masks, pixels: networks produce them at a quarter of the image's size.
constexpr int mask_error = 4;

/// Number of frames over which the size of a modal target is averaged.
constexpr int averaged_frames = 100;

/// Standard deviations by which a size may differ from the average.
constexpr double size_deviations = 2.0;

/// Factor by which another object is wider or higher than one that turns.
constexpr double another_shape = 1.2;

/// Number of differences over which the noise of sizes is averaged, and the standard deviation by
/// the mean absolute difference of two sizes: sqrt(pi) / 2 of a normal distribution.
constexpr double averaged_noise = 20.0, change_to_sigma = 0.8862;

/// The largest standard deviation / size. Larger differences are not noise.
constexpr double most_size_noise = 0.04;

double bad_share(const Visibility& visibility, bool others_hide) {
  return visibility.hidden(others_hide) + visibility.fraction(PixelState::unknown);
}

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

int width_of(const SpanBox& box) { return box.u1 - box.u0 + 1; }
int height_of(const SpanBox& box) { return box.v1 - box.v0 + 1; }

/// Returns whether enough was seen for the verdicts visible and partial.
bool is_seen_enough(const Visibility& visibility, Verdict level, const TargetThresholds& t) {
  if (level == Verdict::hidden) return true;
  const std::size_t least = level == Verdict::visible ? visibility.pixels[PixelState::unknown] : 0;
  if (visibility.seen() <= least) return false;
  return !visibility.is_expected ||
         !(visibility.is_passed(t.past_limit) || visibility.is_unmeasured(t.min_measured));
}

SpanBox grown(const SpanBox& box, int du, int dv) {
  return {box.u0 - du, box.u1 + du, box.v0 - dv, box.v1 + dv};
}

/// Returns whether robot that may hide the target lies in a box, which is clipped to the image.
bool holds_robot(const TargetInFrame& at, const SpanBox& box) {
  const TalliedFrame& frame = at.frame;
  const auto& depth = at.expected.constant;
  const float far = depth ? LimitRule(*frame.rule, at.expected.margin).at(*depth).far
                          : std::numeric_limits<float>::infinity();
  const int u0 = std::max(box.u0, 0), u1 = std::min(box.u1, frame.width - 1);
  const int v0 = std::max(box.v0, 0), v1 = std::min(box.v1, frame.height - 1);
  if (!frame.robot_may_lie_in(u0, u1, v0, v1)) return false;
  for (int v = v0; v <= v1; ++v)
    if (frame.robot_lies_in(u0, u1, v, far)) return true;
  return false;
}

bool lies_in(const SpanBox& inner, const SpanBox& outer) {
  return inner.u0 >= outer.u0 && inner.u1 <= outer.u1 && inner.v0 >= outer.v0 &&
         inner.v1 <= outer.v1;
}

/// Returns the factor from pixels at the expected depth to pixels at the remembered depth; 1 if a
/// depth is unknown. The area in the image is proportional to 1 / depth^2.
double area_scale(const TargetMemory& memory, const TargetView& target) {
  if (!memory.depth || !target.expected_depth) return 1.0;
  return (*target.expected_depth * *target.expected_depth) / (*memory.depth * *memory.depth);
}

/// Returns whether the target has the proportions that are remembered, up to the masks' accuracy.
bool has_proportions(const SpanBox& box, const SpanBox& whole) {
  const double width = width_of(whole), height = height_of(whole);
  return std::abs(width_of(box) / width - height_of(box) / height) <=
         2 * mask_error / std::min(width, height);
}

bool outgrows(const SpanBox& a, const SpanBox& b, double factor) {
  return width_of(a) > factor * width_of(b) || height_of(a) > factor * height_of(b);
}

/// Returns the relative difference of widths and heights that noise and tolerance of areas permit.
double linear_tolerance(const TargetMemory& memory, const TargetThresholds& thresholds) {
  return std::max(size_deviations * memory.size_noise / std::sqrt(2.0),
                  0.5 * thresholds.partial_enter);
}

double pixels_of(std::span<const RowSpan> spans) {
  double pixels = 0;
  for (const RowSpan& span : spans) pixels += span.u1 - span.u0;
  return pixels;
}

/// Adds a size to the average, which it replaces if the target `has_changed`. `scale`: from pixels
/// now to those of the remembered extent.
void add_size(double size, bool has_changed, double scale, TargetMemory& memory) {
  memory.sizes = has_changed ? 1 : std::min(memory.sizes + 1, averaged_frames);
  memory.size += (size - memory.size) / memory.sizes;
  if (memory.extent.empty()) return;
  // Of two successive sizes, because the average lags behind a size that changes.
  const double change = std::abs(size * scale / pixels_of(memory.extent) - 1);
  const double deviation = std::min(change * change_to_sigma, most_size_noise);
  memory.size_noise += (deviation - memory.size_noise) / averaged_noise;
}

}  // namespace

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
  Visibility visibility{.covered = extent.covered(),
                        .inside = extent.inside(),
                        .pixels = tally.pixels,
                        .measured = tally.measured,
                        .past = tally.past,
                        .is_expected = at.expected.known(),
                        .links = &tally.links};
  visibility.unmeasured = visibility.seen() - visibility.measured;
  if (at.frame.images.is_blind) visibility.mark_all_unknown();
  return visibility;
}

Visibility ExtentObserver::observe(const TargetInFrame& at, TargetMemory& memory) {
  if (!at.frame.has_pose()) {
    seen_tally_.clear();
    Visibility none{.covered = seen_.covered(),
                    .inside = seen_.inside(),
                    .links = &seen_tally_.links,
                    .has_pose = false};
    none.pixels[PixelState::unknown] = seen_.inside();
    return none;
  }
  const Visibility now =
      observe_extent(at, seen_, at.wants_depths ? &at.robot : nullptr, seen_tally_);
  return at.target.extent == Extent::modal ? observe_modal(at, memory, now) : now;
}

Visibility ExtentObserver::observe_modal(const TargetInFrame& at, TargetMemory& memory,
                                         const Visibility& now) {
  touches_robot_ = may_be_hidden_ = false;
  if (is_out_of_view(now, at.target.thresholds)) return now;
  const SpanBox box = box_of_spans(seen_.spans());
  touches_robot_ = may_be_hidden_ = holds_robot(at, grown(box, at.reach(), at.reach()));
  move_last(at, memory);
  if (is_other_object(at, memory, box)) {
    const Verdict level = memory.level;
    memory = {};
    memory.level = level;
  }
  if (memory.extent.empty()) {
    Visibility first = now;
    if (may_be_hidden_) first.size_unknown = SizeUnknown::first_near_robot;
    return first;
  }
  Visibility visibility = compare(at, memory, now, box);
  if (memory.is_cut) {
    // More of it exists than was ever seen: assume as much again.
    const SpanBox last = box_of_spans(memory.extent);
    const int more =
        at.reach() + std::max({width_of(box), height_of(box), width_of(last), height_of(last)});
    if (holds_robot(at, grown(box, more, more))) visibility.size_unknown = SizeUnknown::cut;
  }
  return visibility;
}

Visibility ExtentObserver::compare(const TargetInFrame& at, const TargetMemory& memory,
                                   const Visibility& now, const SpanBox& box) {
  const TargetThresholds& thresholds = at.target.thresholds;
  const SpanBox last = box_of_spans(memory.extent);
  const bool is_placed = can_be_part_of_last(at, memory, box);
  const double whole = is_placed && reaches_border() ? static_cast<double>(last_.inside())
                                                     : memory.size / area_scale(memory, at.target);
  const double noise = size_deviations * memory.size_noise * whole;
  const double lacking = std::max(whole - static_cast<double>(now.inside), 0.0);
  const bool may_be_missing = lacking > noise && may_hide_missing(at, box, last);
  const auto missing = may_be_missing ? static_cast<std::size_t>(lacking) : std::size_t{0};
  const double tolerance = std::max(thresholds.partial_enter * whole, noise);
  may_be_hidden_ = touches_robot_ || may_be_missing;
  const bool has_depths = memory.depth && at.target.expected_depth;
  Visibility moved = now;
  const double same = 1 + linear_tolerance(memory, thresholds);
  const bool is_changed = outgrows(box, last, same) || (!is_placed && outgrows(last, box, same));
  if (lacking <= tolerance && touches_robot_ && !has_depths && is_changed) {
    moved.size_unknown = SizeUnknown::moved;  // it may have come nearer and be partly hidden
  } else if (is_placed) {
    const Visibility whole_extent = observe_last(at, missing);
    const bool is_worse =
        bad_share(whole_extent, thresholds.others_hide) >= bad_share(now, thresholds.others_hide);
    return is_worse ? whole_extent : now;
  } else if (lacking > tolerance) {
    moved.covered += missing;
    moved.inside += missing;
    moved.pixels[PixelState::unknown] += missing;
    moved.is_missing = missing > 0;
  }
  return moved;
}

/// Moves the last full extent to its expected place.
void ExtentObserver::move_last(const TargetInFrame& at, const TargetMemory& memory) {
  last_.fill_moved(memory.extent,
                   memory.moved + at.target.motion.value_or(Eigen::Vector2d::Zero()));
  last_.keep(seen_pixels_);
}

/// Returns whether the mask is of another object than the memory, by its size at its depth or its
/// place: a track id was used again.
bool ExtentObserver::is_other_object(const TargetInFrame& at, const TargetMemory& memory,
                                     const SpanBox& box) const {
  if (memory.extent.empty() || memory.is_cut) return false;
  if (is_elsewhere(box)) return true;
  if (!touches_robot_ || !memory.depth || !at.target.expected_depth) return false;
  const double scale = area_scale(memory, at.target);
  const double most =
      1 + std::max(size_deviations * memory.size_noise, at.target.thresholds.partial_enter);
  return static_cast<double>(seen_.inside()) * scale > most * memory.size ||
         outgrows(box, box_of_spans(memory.extent), another_shape / std::sqrt(scale));
}

bool ExtentObserver::is_elsewhere(const SpanBox& box) const {
  if (last_.inside() == 0) return true;
  const SpanBox last = grown(box_of_spans(last_.spans()), mask_error, mask_error);
  return box.u0 > last.u1 || box.u1 < last.u0 || box.v0 > last.v1 || box.v1 < last.v0;
}

/// Returns whether the mask can be part of the last full extent: it has the same expected depth and
/// lies within it.
bool ExtentObserver::can_be_part_of_last(const TargetInFrame& at, const TargetMemory& memory,
                                         const SpanBox& box) const {
  if (last_.inside() == 0) return false;
  const double change = std::abs(area_scale(memory, at.target) - 1.0);
  return change <= at.target.thresholds.partial_enter &&
         lies_in(box, grown(box_of_spans(last_.spans()), mask_error, mask_error));
}

/// Returns whether the robot may hide the missing pixels: it is near the last full extent, or near
/// enough to the mask.
bool ExtentObserver::may_hide_missing(const TargetInFrame& at, const SpanBox& box,
                                      const SpanBox& whole) const {
  const int du = std::max(width_of(whole) - width_of(box), 0);
  const int dv = std::max(height_of(whole) - height_of(box), 0);
  if (holds_robot(at, grown(box, at.reach() + du, at.reach() + dv))) return true;
  return last_.inside() > 0 &&
         holds_robot(at, grown(box_of_spans(last_.spans()), at.reach(), at.reach()));
}

Visibility ExtentObserver::observe_last(const TargetInFrame& at, std::size_t missing) {
  Visibility last = observe_extent(at, last_, nullptr, last_tally_);
  const StateCounts& pixels = last.pixels;
  const std::size_t known =
      pixels[PixelState::occluded] + pixels[PixelState::other] + pixels[PixelState::unknown];
  std::size_t uncertain = missing - std::min(missing, known);
  last.is_missing = missing > 0;
  last.mark_unknown(PixelState::clear, uncertain);
  last.mark_unknown(PixelState::front, uncertain);
  return last;
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
  const SpanBox box = box_of_spans(seen_.spans());
  const bool has_depths = memory.depth && target.expected_depth;
  const bool is_first = memory.extent.empty();
  const double scale = area_scale(memory, target), whole = memory.size / scale;
  const double size = static_cast<double>(seen_.inside());
  const double noise = size_deviations * memory.size_noise;
  const double tolerance = std::max(noise, target.thresholds.partial_enter);
  const bool is_smaller = size<(1 - tolerance) * whole, is_larger = size>(1 + tolerance) * whole;
  const bool is_whole =
      is_first ||
      (may_be_hidden_ ? has_depths && size >= (1 - noise) * whole
                      : !is_smaller || has_proportions(box, box_of_spans(memory.extent)));
  if (!is_whole) {
    const SpanBox last = box_of_spans(memory.extent);
    const double same = 1 + linear_tolerance(memory, target.thresholds);
    if (may_be_hidden_ && !has_depths && !outgrows(box, last, same) && !outgrows(last, box, same))
      memory.moved = Eigen::Vector2d(box.u0 - last.u0, box.v0 - last.v0);
    else
      memory.moved += target.motion.value_or(Eigen::Vector2d::Zero());
    return;
  }
  memory.size = whole;
  if (!may_be_hidden_) add_size(size, is_first || is_smaller || is_larger, scale, memory);
  memory.depth = target.expected_depth;
  memory.extent.assign(seen_.spans().begin(), seen_.spans().end());
  memory.is_cut = reaches_border();
  memory.moved.setZero();
}

Verdict decide(const Visibility& visibility, const TargetThresholds& thresholds,
               TargetMemory& memory) {
  if (is_out_of_view(visibility, thresholds)) return Verdict::out_of_view;
  if (!visibility.has_pose) return Verdict::unknown;
  const double hidden = visibility.hidden(thresholds.others_hide);
  const bool has_size = visibility.size_unknown == SizeUnknown::none;
  const double unknown = has_size ? visibility.fraction(PixelState::unknown) : 1 - hidden;
  // Missing pixels are not seen: unknown_limit does not apply then.
  const bool is_uncertain = !has_size || visibility.is_missing;
  const double limit =
      is_uncertain ? 0 : thresholds.unknown_limit.value_or(thresholds.partial_enter);
  const Verdict level = next_level(memory.level, hidden, thresholds);
  if (unknown > limit && next_level(memory.level, hidden + unknown, thresholds) != level)
    return Verdict::unknown;
  if (!is_seen_enough(visibility, level, thresholds)) return Verdict::unknown;
  memory.level = level;
  return level;
}

}  // namespace penumbra
