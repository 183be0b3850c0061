// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/occlusion/trusted_depth-inl.hpp>

namespace penumbra {
namespace {

constexpr double mad_to_sigma = 1.4826;  // of a normal distribution

int cells_of(int pixels) { return (pixels + LabelRule::cell - 1) / LabelRule::cell; }

/// The mean of the middle one or two of some values, which are put out of order.
float median_of(std::span<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5f * (*middle + *std::max_element(values.begin(), middle));
}

bool trusted_label(std::uint8_t label) {
  return label == static_cast<std::uint8_t>(Label::clear) ||
         label == static_cast<std::uint8_t>(Label::front);
}

struct NoLimits {
  DepthLimits operator()(int /*u*/) const { return {0.0f, std::numeric_limits<float>::infinity()}; }
};

}  // namespace

RobotSurroundings::RobotSurroundings(int width, int height, const LabelRule& rule)
    : cells_(cells_of(std::max(rule.edge_margin, LabelRule{}.edge_margin))),
      beyond_factor_(static_cast<float>(rule.beyond_factor)),
      cell_(cells_of(width), cells_of(height)),
      around_(cells_of(width), cells_of(height)) {}

void RobotSurroundings::begin(const JudgedFrame& frame) {
  frame_ = &frame;
  ++number_;
}

const RobotSurroundings::Cell& RobotSurroundings::cell(int cell_u, int cell_v) {
  Cell& cell = cell_(cell_u, cell_v);
  if (cell.frame == number_) return cell;
  cell = {number_};
  const int u0 = cell_u * LabelRule::cell, v0 = cell_v * LabelRule::cell;
  const int u1 = std::min(u0 + LabelRule::cell, frame_->width);
  const int v1 = std::min(v0 + LabelRule::cell, frame_->height);
  if (!frame_->robot_may_lie_in(u0, u0, v0, v0)) return cell;  // tiles are of whole cells
  for (int v = v0; v < v1; ++v) {
    const float* const z = frame_->images.virtual_depth.depth.row(v);
    for (int u = u0; u < u1; ++u) {
      if (!(z[u] > 0.0f)) continue;
      cell.nearest = std::min(cell.nearest, z[u]);
      cell.farthest = std::max(cell.farthest, z[u]);
    }
  }
  return cell;
}

const RobotSurroundings::Depths& RobotSurroundings::around(int cell_u, int cell_v) {
  Around& result = around_(cell_u, cell_v);
  if (result.frame == number_) return result.depths;
  result = {number_, {}};
  Cell all;
  for (int j = std::max(0, cell_v - cells_); j <= std::min(cell_.height() - 1, cell_v + cells_);
       ++j)
    for (int i = std::max(0, cell_u - cells_); i <= std::min(cell_.width() - 1, cell_u + cells_);
         ++i) {
      const Cell& one = cell(i, j);
      all.nearest = std::min(all.nearest, one.nearest);
      all.farthest = std::max(all.farthest, one.farthest);
    }
  if (all.farthest > 0.0f) {
    const LimitRule rule(*frame_->rule, 0);
    result.depths.from = rule.at(all.nearest).near;
    result.depths.to = all.farthest + beyond_factor_ * (rule.at(all.farthest).far - all.farthest);
  }
  return result.depths;
}

namespace {

/// Takes trusted depths, `limits(v)` and `measured(v)` as for tallies.
template <typename Limits, typename Depths>
void take_trusted(const JudgedFrame& frame, std::span<const RowSpan> spans, const Limits& limits,
                  const Depths& measured, RobotSurroundings& robot, std::vector<float>& depths) {
  const SpanBox box = box_of_spans(spans);
  const int reach = robot.reach();
  const bool near_robot =
      frame.robot_may_lie_in(box.u0 - reach, box.u1 + reach, box.v0 - reach, box.v1 + reach);
  std::size_t count = 0;
  for (const RowSpan& span : spans) {
    const auto row_limits = limits(span.v);
    const auto row = measured.row(span.v);
    const std::uint8_t* const labels = frame.images.labels.labels.row(span.v);
    for (int u = span.u0; u < span.u1;) {
      const int end =
          near_robot ? std::min(span.u1, (u / LabelRule::cell + 1) * LabelRule::cell) : span.u1;
      const RobotSurroundings::Depths of_robot =
          near_robot ? robot.around(u / LabelRule::cell, span.v / LabelRule::cell)
                     : RobotSurroundings::Depths{};
      for (; u < end; ++u) {
        const float d = row[u];
        const DepthLimits within = row_limits(u);
        depths[count] = d;
        const bool trusted = (d > 0.0f) & trusted_label(labels[u]) & !of_robot.hold(d) &
                             (within.near <= d) & (d <= within.far);
        count += trusted ? 1 : 0;
      }
    }
  }
  depths.resize(count);
}

}  // namespace

void TrustedDepths::take(const JudgedFrame& frame, std::span<const RowSpan> spans,
                         const ExpectedDepth& expected, RobotSurroundings& robot) {
  std::size_t pixels = 0;
  for (const RowSpan& span : spans) pixels += static_cast<std::size_t>(span.u1 - span.u0);
  depths_.resize(pixels);
  if (pixels == 0) return;
  const LimitRule rule(*frame.rule, expected.margin);
  std::visit(
      [&](const auto& image) {
        const Measured measured(image, *frame.rule);
        const auto take_with = [&](const auto& limits) {
          take_trusted(frame, spans, limits, measured, robot, depths_);
        };
        if (expected.image)
          take_with([&](int v) {
            return [z = expected.image->row(v), rule](int u) { return rule.at(z[u]); };
          });
        else if (expected.constant)
          take_with([limits = rule.at(*expected.constant)](int) {
            return [limits](int) { return limits; };
          });
        else
          take_with([](int) { return NoLimits{}; });
      },
      frame.images.measured);
}

RobustDepth TrustedDepths::robust() {
  RobustDepth depth{.count = depths_.size()};
  const float median = median_of(depths_);
  for (float& d : depths_) d = std::abs(d - median);
  depth.median = static_cast<double>(median);
  depth.spread = mad_to_sigma * static_cast<double>(median_of(depths_));
  return depth;
}

}  // namespace penumbra
