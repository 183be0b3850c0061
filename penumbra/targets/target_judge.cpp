// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/targets/extent_tally.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/targets/trusted_depth.hpp>

namespace penumbra {
namespace {

/// Accuracy of masks, pixels: networks produce them at a quarter of the image's size.
constexpr int mask_error = 4;

/// Rounding of widths and heights, pixels.
constexpr int rounding = 1;

/// By which a remembered extent is scaled at most, to stay within integers.
constexpr double largest_scale = 100.0;

Eigen::Array2d first_of(const PixelRectangle& box) { return {box.u0, box.v0}; }
Eigen::Array2d end_of(const PixelRectangle& box) { return {box.u1, box.v1}; }
Eigen::Array2d size_of(const PixelRectangle& box) { return end_of(box) - first_of(box); }

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

LabelRule checked_rule(const LabelRule& rule) {
  rule.check();
  return rule;
}

ExpectedDepth expected_of(const TargetView& target) {
  ExpectedDepth expected;
  expected.margin = target.depth_margin;
  if (const auto* rendered = std::get_if<RenderedRegion>(&target.region))
    expected.image = rendered->depth.view;
  else if (target.expected_depth)
    expected.constant = static_cast<float>(*target.expected_depth);
  return expected;
}

/// Returns whether more than half of the unknown pixels lie outside the lens model.
bool is_uncovered(const LabelledImages& images, std::span<const RowSpan> extent,
                  std::size_t unknown) {
  if (images.virtual_depth.depth.empty()) return false;
  std::size_t uncovered = 0;
  for (const RowSpan& span : extent) {
    const std::uint8_t* const labels = images.labels.labels.row(span.v);
    const float* const z = images.virtual_depth.depth.row(span.v);
    for (int u = span.u0; u < span.u1; ++u)
      if (labels[u] == static_cast<std::uint8_t>(Label::unknown) && !(z[u] > 0.0f)) ++uncovered;
  }
  return 2 * uncovered > unknown;
}

/// As detail::median(), for values of at least 0, in a third of the time: counts them by the bits
/// of the range that they lie in, and keeps those of the median's bits.
float median_size(std::vector<float>& values) {
  constexpr int bits = 8;
  const auto key = [](float value) { return std::bit_cast<std::int32_t>(value); };  // in order
  std::int32_t low = key(values[0]), high = low;
  for (const float value : values) {
    low = std::min(low, key(value));
    high = std::max(high, key(value));
  }
  const auto width = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(high - low)));
  const int shift = std::max(0, width - bits);
  const auto bin_of = [&](float value) {
    return static_cast<std::size_t>((key(value) - low) >> shift);
  };
  std::array<std::size_t, 1 << bits> counts{};
  for (const float value : values) ++counts[bin_of(value)];
  std::size_t rank = values.size() / 2, bin = 0, kept = 0;
  while (counts[bin] <= rank) rank -= counts[bin++];
  for (float& value : values) {
    std::swap(value, values[kept]);
    kept += bin_of(values[kept]) == bin ? 1 : 0;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.begin() + static_cast<std::ptrdiff_t>(kept));
  return *at;
}

}  // namespace

struct TargetJudge::State {
  State(const Camera& camera_, const LabelRule& rule, std::size_t links,
        ImageView<const std::uint8_t> unseen);

  Judgement judge(const TargetView& target, TargetMemory& memory);
  Judgement judge_at_depth(const TargetView& target, TargetMemory& memory);
  void fill(const Region& region);
  [[nodiscard]] std::optional<double> depth_by_height(const TargetView& target,
                                                      const TargetMemory& memory) const;
  ExtentTally& observe(const TargetView& target, const ExpectedDepth& expected,
                       TargetMemory& memory);
  ExtentTally& observe_modal(const TargetView& target, const ExpectedDepth& expected,
                             TargetMemory& memory);
  [[nodiscard]] bool place_whole(const TargetView& target, const TargetMemory& memory,
                                 const PixelRectangle& box);
  [[nodiscard]] bool has_pose() const { return !images.virtual_depth.depth.empty(); }
  [[nodiscard]] bool is_measured() const { return images.evidence == Evidence::measured; }
  [[nodiscard]] bool holds_robot(const ExpectedDepth& expected, const PixelRectangle& box) const;
  [[nodiscard]] bool reaches_border() const;
  void remember(const TargetView& target, TargetMemory& memory) const;
  void add_point(const TargetView& target, Judgement& judgement);

  Camera camera;
  labelling::Rule rule;
  LabelledImages images;  // of the frame
  bool has_frame = false;
  bool has_outside;  // as RobotSurroundings
  RobotSurroundings robot;
  SeenPixels seen_pixels;
  RegionSpans seen, whole;  // the given extent, and the remembered one
  ExtentTally seen_tally, whole_tally;
  // Of the last modal extent:
  Eigen::Array2d whole_size{0, 0};  // pixels, of the remembered extent; 0: none
  Eigen::Vector2d moved{0, 0};      // of that
  bool is_near_robot = false;
  bool is_hidden_by_other = false;  // in part
};

TargetJudge::State::State(const Camera& camera_, const LabelRule& label_rule, std::size_t links,
                          ImageView<const std::uint8_t> unseen)
    : camera(camera_.check()),
      rule(checked_rule(label_rule)),
      has_outside(!unseen.empty()),
      robot(camera.intrinsics.width(), camera.intrinsics.height(), label_rule, has_outside),
      seen_pixels(unseen),
      seen(camera.intrinsics.width(), camera.intrinsics.height()),
      whole(seen),
      seen_tally(links),
      whole_tally(links) {}

TargetJudge::TargetJudge(const Camera& camera, const LabelRule& rule, std::size_t links,
                         ImageView<const std::uint8_t> unseen)
    : state_(std::make_unique<State>(camera, rule, links, unseen)) {}
TargetJudge::~TargetJudge() = default;
TargetJudge::TargetJudge(TargetJudge&&) noexcept = default;
TargetJudge& TargetJudge::operator=(TargetJudge&&) noexcept = default;

void TargetJudge::begin(const LabelledImages& images) {
  const Intrinsics& size = state_->camera.intrinsics;
  const auto check = [&](const char* what, const auto& image, bool may_be_empty) {
    if (image.width == size.width() && image.height == size.height() && image.data != nullptr)
      return;
    if (image.empty() && may_be_empty) return;
    region_fault(what, " of ", image.width, " x ", image.height, " pixels: the camera's has ",
                 size.width(), " x ", size.height());
  };
  check("label image", images.labels.labels, false);
  check("virtual depth image", images.virtual_depth.depth, true);
  check("link image", images.virtual_depth.links, true);
  const bool is_measured = images.evidence == Evidence::measured;
  std::visit([&](const auto& depth) { check("depth image", depth, !is_measured); },
             images.measured);
  state_->images = images;
  state_->robot.begin(state_->images);
  state_->has_frame = true;
}

Judgement TargetJudge::judge(const TargetView& target, TargetMemory& memory) {
  if (!state_->has_frame) throw std::logic_error("TargetJudge::judge() before begin()");
  return state_->judge(target, memory);
}

Judgement TargetJudge::judge(const TargetView& target) {
  TargetMemory none;
  return judge(target, none);
}

Judgement TargetJudge::State::judge(const TargetView& target, TargetMemory& memory) {
  check_view(target);
  if (!target.height || target.expected_depth) return judge_at_depth(target, memory);
  fill(target.region);
  TargetView placed = target;
  placed.expected_depth = depth_by_height(target, memory);
  return judge_at_depth(placed, memory);
}

Judgement TargetJudge::State::judge_at_depth(const TargetView& target, TargetMemory& memory) {
  fill(target.region);
  ExtentTally& tally = observe(target, expected_of(target), memory);
  const std::size_t unknown = tally.pixels[PixelState::unknown];
  tally.is_uncovered =
      unknown > 0 && !camera.distortion.is_none() && is_uncovered(images, seen.spans(), unknown);
  Judgement judgement = judgement_of(tally, images, target.thresholds, memory);
  if (target.extent == Extent::modal && judgement.verdict == Verdict::visible)
    remember(target, memory);
  distrust(images, judgement);
  if (target.wants_point && is_measured()) add_point(target, judgement);
  return judgement;
}

void TargetJudge::State::fill(const Region& region) {
  seen.fill(region);
  seen.keep(seen_pixels);
}

/// Returns whether robot that may hide the target lies in a box, which is clipped to the image.
bool TargetJudge::State::holds_robot(const ExpectedDepth& expected,
                                     const PixelRectangle& box) const {
  const auto& depth = expected.constant;
  const float far = depth ? LimitRule(rule, expected.margin).at(*depth).far
                          : std::numeric_limits<float>::infinity();
  if (!robot_may_lie_in(images, box)) return false;
  const auto [u0, v0, u1, v1] =
      overlap(box, {0, 0, camera.intrinsics.width(), camera.intrinsics.height()});
  for (int v = v0; v < v1; ++v) {
    const std::uint8_t* const labels = images.labels.labels.row(v);
    const float* const z = images.virtual_depth.depth.row(v);
    for (int u = u0; u < u1; ++u) {
      u += first_set(labels + u, u1 - u);
      if (u < u1 && labels[u] != static_cast<std::uint8_t>(Label::fringe) && z[u] <= far &&
          (z[u] > 0.0f || !has_outside))
        return true;
    }
  }
  return false;
}

/// Returns the expected depth of an object of known height, metres, or the remembered one where a
/// modal region may be cut.
std::optional<double> TargetJudge::State::depth_by_height(const TargetView& target,
                                                          const TargetMemory& memory) const {
  if (seen.spans().empty() || !has_pose()) return memory.depth;
  const PixelRectangle box = box_of_spans(seen.spans());
  if (target.extent == Extent::modal) {
    // As in observe_modal, which judges what is near the robot by the whole extent alone.
    Eigen::Array2d around(robot.reach(), robot.reach());
    if (!memory.whole.empty())
      around = 2 * around + (size_of(box_of_spans(memory.whole)) - size_of(box)).max(0);
    const PixelRectangle near =
        grown(box, static_cast<int>(around.x()), static_cast<int>(around.y()));
    if (reaches_border() || holds_robot({}, near)) return memory.depth;
  }
  const auto* const exact = std::get_if<PixelBox>(&target.region);
  const double height = exact != nullptr ? exact->height : size_of(box).y();
  return camera.intrinsics.fy() * *target.height / height;
}

/// Returns the tally of the region of fill(), or of the whole extent that it is a part of. Forgets
/// the remembered extent if the region is of another object.
ExtentTally& TargetJudge::State::observe(const TargetView& target, const ExpectedDepth& expected,
                                         TargetMemory& memory) {
  ExtentTally& tally = seen_tally;
  if (has_pose()) {
    const bool wants_depths = target.wants_point && is_measured();
    tally.count(images, rule, seen.spans(), expected, target.thresholds.beyond_hides,
                wants_depths ? &robot : nullptr);
  } else {
    tally.clear();
    tally.inside = tally.pixels[PixelState::unknown] = seen.inside();
    tally.has_pose = false;
  }
  tally.covered = seen.covered();
  const bool is_modal = target.extent == Extent::modal && has_pose();
  return is_modal ? observe_modal(target, expected, memory) : tally;
}

/// What is missing of the last whole extent is hidden where another object is measured before it,
/// and near the robot unknown elsewhere.
ExtentTally& TargetJudge::State::observe_modal(const TargetView& target,
                                               const ExpectedDepth& expected,
                                               TargetMemory& memory) {
  is_near_robot = is_hidden_by_other = false;
  if (seen_tally.is_out_of_view(target.thresholds)) return seen_tally;
  const PixelRectangle box = box_of_spans(seen.spans());
  const bool is_there = place_whole(target, memory, box);
  // Masks may keep away from what hides their targets, and shrink before it touches them.
  const int reach = memory.whole.empty() ? robot.reach() : 2 * robot.reach();
  const Eigen::Array2d around = (whole_size - size_of(box)).max(0) + reach;
  is_near_robot =
      holds_robot(expected, grown(box, static_cast<int>(around.x()), static_cast<int>(around.y())));
  const bool is_other = outgrows(size_of(box), whole_size, target.thresholds);
  if (is_near_robot ? is_other : !is_there) memory.whole.clear();
  const bool is_known = !is_other && is_there && !reaches_border();
  if (!is_known) {
    seen_tally.has_whole = !is_near_robot;
    return seen_tally;
  }
  const auto all = static_cast<double>(whole.covered());
  // What it exceeds the extent in one direction does not make up for what lacks in the other.
  const double excess = (size_of(box) / whole_size).max(1).prod();
  const double missing = all - static_cast<double>(seen.inside()) / excess;
  const double unnoticed = is_near_robot ? target.thresholds.partial_enter * all : 0.0;
  if (missing <= unnoticed || (!is_near_robot && !expected.known())) return seen_tally;
  whole_tally.count(images, rule, whole.spans(), expected, target.thresholds.beyond_hides, nullptr);
  const auto lacks = static_cast<std::size_t>(missing);
  if (!is_near_robot) {  // a target that turns lacks pixels, too: only what hides it counts
    std::size_t& other = seen_tally.pixels[PixelState::other];
    const std::size_t hidden = whole_tally.pixels[PixelState::other];
    const std::size_t more = std::min(lacks, hidden - std::min(hidden, other));
    other += more;
    seen_tally.inside += more;
    seen_tally.covered += more;
    is_hidden_by_other = more > 0;
    return seen_tally;
  }
  whole_tally.covered = whole.covered();
  whole_tally.is_missing = true;
  const std::size_t known = whole_tally.inside - whole_tally.seen();
  std::size_t uncertain = lacks - std::min(lacks, known);
  whole_tally.mark_unknown(PixelState::clear, uncertain);
  whole_tally.mark_unknown(PixelState::front, uncertain);
  return whole_tally;
}

/// Scales the last whole extent to the target's depth, moves it by the target's track, and then as
/// little as lets it hold what is seen. Returns whether anything is seen where it is expected.
bool TargetJudge::State::place_whole(const TargetView& target, const TargetMemory& memory,
                                     const PixelRectangle& box) {
  whole_size.setZero();
  if (memory.whole.empty()) return false;
  const PixelRectangle last = box_of_spans(memory.whole);
  const double scale = scale_of(memory, target);
  whole_size = scale * size_of(last);
  moved = memory.moved + target.motion.value_or(Eigen::Vector2d::Zero());
  const Eigen::Array2d expected =
      first_of(last) + 0.5 * (size_of(last) - whole_size) + moved.array();
  const Eigen::Array2d a = first_of(box), b = end_of(box) - whole_size;
  const Eigen::Array2d first = expected.max(a.min(b)).min(a.max(b));
  moved += (first - expected).matrix();
  whole.fill_scaled(memory.whole, scale, first - scale * first_of(last));
  whole.keep(seen_pixels);
  return (expected - mask_error <= end_of(box)).all() &&
         (expected + whole_size + mask_error >= first_of(box)).all();
}

bool TargetJudge::State::reaches_border() const {
  return std::ranges::any_of(seen.spans(), [&](const RowSpan& span) {
    for (const int dv : {-mask_error, 0, mask_error}) {
      const RowSpan around{span.v + dv, span.u0 - mask_error, span.u1 + mask_error};
      if (!seen_pixels.hold(around, camera.intrinsics.width(), camera.intrinsics.height()))
        return true;
    }
    return false;
  });
}

/// Stores the modal extent of the last call, which was visible.
void TargetJudge::State::remember(const TargetView& target, TargetMemory& memory) const {
  const bool has_whole = !memory.whole.empty();
  const Eigen::Array2d size = size_of(box_of_spans(seen.spans()));
  if (has_whole) memory.moved = moved;
  if (is_near_robot || reaches_border()) return;
  if (has_whole && (is_hidden_by_other || is_covered(size, whole_size, target.thresholds))) return;
  memory.whole.assign(seen.spans().begin(), seen.spans().end());
  memory.depth = target.expected_depth;
  memory.moved.setZero();
}

void TargetJudge::State::add_point(const TargetView& target, Judgement& judgement) {
  if (judgement.verdict != Verdict::visible && judgement.verdict != Verdict::partial) return;
  ExtentTally& tally = seen_tally;
  const std::size_t inside = seen.inside();
  const std::size_t trusted =
      std::min(inside, tally.depths.size() * static_cast<std::size_t>(tally.step));
  const double least = target.thresholds.point_min_fraction * static_cast<double>(inside);
  if (trusted == 0 || trusted < target.thresholds.point_min_pixels ||
      static_cast<double>(trusted) < least)
    return;
  const Eigen::Vector2d pixel = target.point_pixel.value_or(seen.middle());
  const Intrinsics& pinhole = camera.intrinsics;
  const Eigen::Vector2d distorted = pinhole.ray(pixel.x(), pixel.y()).head<2>();
  const auto ray = camera.distortion.undistort(distorted);
  if (!ray) return;
  const float median = median_size(tally.depths);
  for (float& depth : tally.depths) depth = std::abs(depth - median);
  judgement.point = static_cast<double>(median) * Eigen::Vector3d(ray->x(), ray->y(), 1.0);
  judgement.point_pixels = trusted;
  judgement.point_spread = detail::normal_sigma * static_cast<double>(median_size(tally.depths));
}

}  // namespace penumbra
