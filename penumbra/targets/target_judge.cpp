// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/statistics-inl.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/targets/target_visibility.hpp>
#include <penumbra/targets/trusted_depth.hpp>

namespace penumbra {
namespace {

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
bool is_uncovered(const TalliedFrame& frame, std::span<const RowSpan> extent, std::size_t unknown) {
  if (frame.images.virtual_depth.depth.empty()) return false;
  std::size_t uncovered = 0;
  for (const RowSpan& span : extent) {
    const std::uint8_t* const labels = frame.images.labels.labels.row(span.v);
    const float* const z = frame.images.virtual_depth.depth.row(span.v);
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

void check_view(const TargetView& target) {
  const bool rendered = std::holds_alternative<RenderedRegion>(target.region);
  const std::optional<double>& depth = target.expected_depth;
  const double most = static_cast<double>(RenderedRegion::max_depth);
  if (rendered && target.extent == Extent::modal)
    region_fault("a rendered region is the full extent: amodal");
  if (rendered && depth) region_fault("a rendered region has its own expected depth: give none");
  if (rendered && target.thresholds.min_inside > 0)
    region_fault("min_inside ", target.thresholds.min_inside,
                 ": what of a rendered region lies outside of the image is not known: must be 0");
  if (depth && !(*depth > 0 && *depth <= most))
    region_fault("expected depth ", *depth, " m: must be above 0 and up to ", most);
  if (!(target.depth_margin >= 0 && target.depth_margin <= most))
    region_fault("depth margin ", target.depth_margin, " m: must be 0 to ", most);
  if (target.point_pixel && !target.point_pixel->allFinite())
    region_fault("point pixel: must be numbers");
  if (target.motion && !(target.motion->cwiseAbs().maxCoeff() <= max_coordinate))
    region_fault("motion: must be numbers up to ", max_coordinate, " pixels");
  target.thresholds.check();
}

void TargetThresholds::check() const {
  check_settings(*this);
  const auto check_order = [](const char* low_name, double low, const char* high_name,
                              double high) {
    if (low > high) region_fault(low_name, ' ', low, ": must not exceed ", high_name, ' ', high);
  };
  check_order("partial_leave", partial_leave, "partial_enter", partial_enter);
  check_order("hidden_leave", hidden_leave, "hidden_enter", hidden_enter);
  check_order("partial_enter", partial_enter, "hidden_enter", hidden_enter);
  check_order("partial_leave", partial_leave, "hidden_leave", hidden_leave);
}

struct TargetJudge::State {
  State(const Camera& camera_, const LabelRule& rule, std::size_t links,
        ImageView<const std::uint8_t> unseen);

  Judgement judge(const TargetView& target, TargetMemory& memory);
  Judgement judge_at_depth(const TargetView& target, TargetMemory& memory);
  void add_point(const TargetView& target, Judgement& judgement);

  Camera camera;
  labelling::Rule rule;
  TalliedFrame frame;
  bool has_frame = false;
  RobotSurroundings robot;
  ExtentObserver observer;
};

TargetJudge::State::State(const Camera& camera_, const LabelRule& label_rule, std::size_t links,
                          ImageView<const std::uint8_t> unseen)
    : camera(camera_.check()),
      rule(checked_rule(label_rule)),
      frame({}, rule, !unseen.empty()),
      robot(camera.intrinsics.width(), camera.intrinsics.height(), label_rule),
      observer(camera.intrinsics.width(), camera.intrinsics.height(), links, SeenPixels(unseen)) {}

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
  state_->frame = TalliedFrame(images, state_->rule, state_->frame.is_outside_undrawn);
  state_->robot.begin(state_->frame);
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
  observer.fill(target.region);
  TargetView placed = target;
  placed.expected_depth =
      observer.depth_by_height({frame, target, {}, robot, false}, memory, camera.intrinsics.fy());
  return judge_at_depth(placed, memory);
}

Judgement TargetJudge::State::judge_at_depth(const TargetView& target, TargetMemory& memory) {
  const ExpectedDepth expected = expected_of(target);
  observer.fill(target.region);
  const bool wants_depths = target.wants_point && frame.is_measured();
  Visibility visibility = observer.observe({frame, target, expected, robot, wants_depths}, memory);
  const std::size_t unknown = visibility.pixels[PixelState::unknown];
  visibility.is_uncovered = unknown > 0 && !camera.distortion.is_none() &&
                            is_uncovered(frame, observer.seen().spans(), unknown);
  Judgement judgement = visibility.judge(frame.images, target.thresholds, memory);
  if (target.extent == Extent::modal && judgement.verdict == Verdict::visible)
    observer.remember(target, memory);
  distrust(frame.images, judgement);
  if (wants_depths) add_point(target, judgement);
  return judgement;
}

void TargetJudge::State::add_point(const TargetView& target, Judgement& judgement) {
  if (judgement.verdict != Verdict::visible && judgement.verdict != Verdict::partial) return;
  ExtentTally& tally = observer.tally();
  const std::size_t inside = observer.seen().inside();
  const std::size_t trusted =
      std::min(inside, tally.depths.size() * static_cast<std::size_t>(tally.step));
  const double least = target.thresholds.point_min_fraction * static_cast<double>(inside);
  if (trusted == 0 || trusted < target.thresholds.point_min_pixels ||
      static_cast<double>(trusted) < least)
    return;
  const Eigen::Vector2d pixel = target.point_pixel.value_or(observer.seen().middle());
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
