// SPDX-License-Identifier: Apache-2.0
// Which depths may be of the robot, and the median of the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <penumbra/targets/extent_tally-inl.hpp>

namespace penumbra {

/// Which measured depths may be of the robot where it stands near: the sensor sees its edges
/// blurred and, by calibration, out of place. Worked out for each cell of LabelRule::cell pixels
/// squared that is asked for, once a frame.
class RobotSurroundings {
 public:
  RobotSurroundings(int width, int height, const LabelRule& rule);

  /// Forgets the last frame. `frame` is read until the next call.
  void begin(const TalliedFrame& frame);

  /// Depths that may be of the robot within edge_margin pixels of a cell; none: from > to.
  struct Depths {
    float from = std::numeric_limits<float>::infinity(), to = 0;
    [[nodiscard]] bool hold(float d) const { return from <= d && d <= to; }
  };
  [[nodiscard]] const Depths& around(int cell_u, int cell_v);

  /// Pixels past a region in which the robot matters to it.
  [[nodiscard]] int reach() const { return (cells_ + 1) * LabelRule::cell; }

 private:
  struct Cell {
    std::uint64_t frame = 0;
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  };
  struct Around {
    std::uint64_t frame = 0;
    Depths depths;
  };

  [[nodiscard]] const Cell& cell(int cell_u, int cell_v);

  int cells_;  // how many of them the margin reaches
  float beyond_factor_;
  const TalliedFrame* frame_ = nullptr;
  std::uint64_t number_ = 0;
  Image<Cell> cell_;
  Image<Around> around_;
};

/// The median of some depths.
struct RobustDepth {
  double median = 0;  ///< metres
  double spread = 0;  ///< metres: 1.4826 * median absolute deviation
};

/// Returns the median of one or more depths; changes them.
[[nodiscard]] RobustDepth robust_depth(std::span<float> depths);

}  // namespace penumbra
