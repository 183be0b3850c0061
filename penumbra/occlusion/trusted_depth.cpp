// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include <penumbra/occlusion/trusted_depth-inl.hpp>

namespace penumbra {
namespace {

constexpr double mad_to_sigma = 1.4826;  // of a normal distribution

/// Of robot that cannot be drawn, as the lens model does not reach there.
constexpr float any_depth = std::numeric_limits<float>::infinity();

int cells_of(int pixels) { return (pixels + LabelRule::cell - 1) / LabelRule::cell; }

/// Floats, 0 or more, by their bits: their order is that of the floats.
using FloatBits = std::span<const std::int32_t>;

std::size_t count_up_to(FloatBits values, std::int32_t limit) {
  std::int32_t count = 0;  // as wide as a value: so the compiler takes vectors
  for (const std::int32_t value : values) count += value <= limit ? 1 : 0;
  return static_cast<std::size_t>(count);
}

std::int32_t least_above(FloatBits values, std::int32_t limit) {
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  for (const std::int32_t value : values) least = std::min(least, value > limit ? value : least);
  return least;
}

/// The value that `rank` values of `values` precede in order. Counts, which are cheap, leave few of
/// them, which are put in order. `scratch` has their size.
std::int32_t ranked_value(FloatBits values, std::size_t rank, std::span<std::int32_t> scratch) {
  constexpr std::size_t few = 32, share = 6;
  std::int32_t low = values[0], high = values[0];
  for (const std::int32_t value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  std::size_t below = 0, upto = values.size();  // how many are < low, and <= high
  while (low < high && upto - below > few + values.size() / share) {
    const float between = 0.5f * (std::bit_cast<float>(low) + std::bit_cast<float>(high));
    const std::int32_t middle = std::min(std::bit_cast<std::int32_t>(between), high - 1);
    const std::size_t count = count_up_to(values, middle);
    if (count > rank)
      high = middle, upto = count;
    else
      low = middle + 1, below = count;
  }
  if (low == high) return low;
  std::size_t count = 0;
  for (const std::int32_t value : values) {
    scratch[count] = value;
    count += static_cast<std::size_t>((low <= value) & (value <= high));
  }
  const auto wanted = scratch.begin() + static_cast<std::ptrdiff_t>(rank - below);
  std::nth_element(scratch.begin(), wanted, scratch.begin() + static_cast<std::ptrdiff_t>(count));
  return *wanted;
}

/// The mean of the middle one or two.
float median_of(FloatBits values, std::span<std::int32_t> scratch) {
  const std::size_t rank = (values.size() - 1) / 2;
  const std::int32_t lower = ranked_value(values, rank, scratch);
  const bool is_double = values.size() % 2 == 1 || count_up_to(values, lower) > rank + 1;
  const std::int32_t upper = is_double ? lower : least_above(values, lower);
  return 0.5f * (std::bit_cast<float>(lower) + std::bit_cast<float>(upper));
}

}  // namespace

RobotSurroundings::RobotSurroundings(int width, int height, const LabelRule& rule)
    : cells_(cells_of(std::max(rule.edge_margin, LabelRule{}.edge_margin))),
      beyond_factor_(static_cast<float>(rule.beyond_factor)),
      cell_(cells_of(width), cells_of(height)),
      around_(cells_of(width), cells_of(height)) {}

void RobotSurroundings::begin(const LabelledFrame& frame) {
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
    const std::uint8_t* const labels = frame_->images.labels.labels.row(v);
    const float* const z = frame_->images.virtual_depth.depth.row(v);
    for (int u = u0; u < u1; ++u) {
      if (labels[u] == static_cast<std::uint8_t>(Label::clear) ||
          labels[u] == static_cast<std::uint8_t>(Label::fringe))
        continue;
      const bool is_drawn = z[u] > 0.0f;
      if (!is_drawn && frame_->is_outside_undrawn) continue;
      cell.nearest = std::min(cell.nearest, is_drawn ? z[u] : 0.0f);
      cell.farthest = std::max(cell.farthest, is_drawn ? z[u] : any_depth);
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
  if (all.farthest == any_depth) {
    result.depths = {0.0f, any_depth};
  } else if (all.farthest > 0.0f) {
    const LimitRule rule(*frame_->rule, 0);
    result.depths.from = rule.at(all.nearest).near;
    result.depths.to = all.farthest + beyond_factor_ * (rule.at(all.farthest).far - all.farthest);
  }
  return result.depths;
}

namespace {

/// Takes depths of one frame that are trusted.
template <typename Depths>
class Gatherer {
 public:
  Gatherer(const LabelledFrame& frame, const Depths& measured, RobotSurroundings* robot,
           std::int32_t* out)
      : frame_(frame), measured_(measured), robot_(robot), out_(out) {}

  template <typename Limits>
  void take(const RowSpan& span, const Limits& limits) {
    const std::uint8_t* const labels = frame_.images.labels.labels.row(span.v);
    const auto row = measured_.row(span.v);
    for (int u = span.u0; u < span.u1;) {
      const std::uint8_t label = labels[u];
      const int end = static_cast<int>(end_of_run(labels + u, labels + span.u1) - labels);
      if (!is_trusted(static_cast<Label>(label)))
        u = end;
      else if (robot_ == nullptr)
        u = take_run(u, end, row, limits, {});
      else
        while (u < end) {
          const int cell = u / LabelRule::cell;
          const auto& of_robot = robot_->around(cell, span.v / LabelRule::cell);
          u = take_run(u, std::min(end, (cell + 1) * LabelRule::cell), row, limits, of_robot);
        }
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  template <typename Row, typename Limits>
  int take_run(int u, int end, const Row& row, const Limits& limits,
               RobotSurroundings::Depths of_robot) {
    std::size_t count = count_;
    std::int32_t* const out = out_;
    for (; u < end; ++u) {
      const float d = row[u];
      const DepthLimits within = limits(u);
      out[count] = std::bit_cast<std::int32_t>(d);
      count += static_cast<std::size_t>((d > 0.0f) & !of_robot.hold(d) & (within.near <= d) &
                                        (d <= within.far));
    }
    count_ = count;
    return end;
  }

  const LabelledFrame& frame_;
  const Depths& measured_;
  RobotSurroundings* robot_;  // null: none is near
  std::int32_t* out_;
  std::size_t count_ = 0;
};

}  // namespace

void TrustedDepths::take(const LabelledFrame& frame, std::span<const RowSpan> spans,
                         const ExpectedDepth& expected, RobotSurroundings& robot) {
  const SpanBox box = box_of_spans(spans);
  const int reach = robot.reach();
  const bool near_robot =
      frame.robot_may_lie_in(box.u0 - reach, box.u1 + reach, box.v0 - reach, box.v1 + reach);
  std::size_t pixels = 0;
  for (const RowSpan& span : spans) pixels += static_cast<std::size_t>(span.u1 - span.u0);
  if (bits_.size() < pixels) {
    bits_.resize(pixels);
    scratch_.resize(pixels);
  }
  std::visit(
      [&](const auto& image) {
        const Measured measured(image, *frame.rule);
        Gatherer gatherer(frame, measured, near_robot ? &robot : nullptr, bits_.data());
        with_limits(*frame.rule, expected, [&](const auto& limits) {
          for (const RowSpan& span : spans) gatherer.take(span, limits(span.v));
        });
        count_ = gatherer.count();
      },
      frame.images.measured);
}

RobustDepth TrustedDepths::robust() {
  const std::span<std::int32_t> bits(bits_.data(), count_);
  const float median = median_of(bits, scratch_);
  for (std::int32_t& value : bits)
    value = std::bit_cast<std::int32_t>(std::abs(std::bit_cast<float>(value) - median));
  return {count_, static_cast<double>(median),
          mad_to_sigma * static_cast<double>(median_of(bits, scratch_))};
}

}  // namespace penumbra
