// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/targets/trusted_depth.hpp>

namespace penumbra {
namespace {

/// Depth of robot outside the lens model, which cannot be rendered.
constexpr float any_depth = std::numeric_limits<float>::infinity();

int cells_of(int pixels) { return (pixels + LabelRule::cell - 1) / LabelRule::cell; }

}  // namespace

RobotSurroundings::RobotSurroundings(int width, int height, const LabelRule& rule, bool has_outside)
    : cells_(cells_of(std::max(rule.edge_margin, LabelRule{}.edge_margin))),
      beyond_factor_(static_cast<float>(rule.beyond_factor)),
      rule_(rule),
      has_outside_(has_outside),
      cell_(cells_of(width), cells_of(height)),
      around_(cells_of(width), cells_of(height)) {}

void RobotSurroundings::begin(const LabelledImages& images) {
  images_ = &images;
  ++number_;
}

const RobotSurroundings::Cell& RobotSurroundings::cell(int cell_u, int cell_v) {
  Cell& cell = cell_(cell_u, cell_v);
  if (cell.frame == number_) return cell;
  cell = {number_};
  const int u0 = cell_u * LabelRule::cell, v0 = cell_v * LabelRule::cell;
  const auto& image = images_->labels.labels;
  const int u1 = std::min(u0 + LabelRule::cell, image.width);
  const int v1 = std::min(v0 + LabelRule::cell, image.height);
  if (!robot_may_lie_in(*images_, {u0, v0, u0 + 1, v0 + 1})) return cell;  // tiles: whole cells
  for (int v = v0; v < v1; ++v) {
    const std::uint8_t* const labels = image.row(v);
    const float* const z = images_->virtual_depth.depth.row(v);
    for (int u = u0; u < u1; ++u) {
      if (labels[u] == static_cast<std::uint8_t>(Label::clear) ||
          labels[u] == static_cast<std::uint8_t>(Label::fringe))
        continue;
      const bool is_drawn = z[u] > 0.0f;
      if (!is_drawn && has_outside_) continue;
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
    const LimitRule rule(rule_, 0);
    result.depths.from = rule.at(all.nearest).near;
    // Also with fold_beyond, which is about labels: a depth that lies farther is not the robot's.
    result.depths.to = all.farthest + beyond_factor_ * (rule.at(all.farthest).far - all.farthest);
  }
  return result.depths;
}

}  // namespace penumbra
