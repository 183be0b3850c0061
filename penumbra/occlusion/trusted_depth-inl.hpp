// SPDX-License-Identifier: Apache-2.0
// The depth of a target from the measurements inside it that cannot be of the robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <penumbra/occlusion/extent_tally-inl.hpp>

namespace penumbra {

/// Which measured depths may be of the robot where it stands near: the sensor sees its edges
/// blurred and, by calibration, out of place. Worked out for each cell of LabelRule::cell pixels
/// squared that is asked for, once a frame.
class RobotSurroundings {
 public:
  RobotSurroundings(int width, int height, const LabelRule& rule);

  /// Forgets the last frame. `frame` is looked at until the next call.
  void begin(const LabelledFrame& frame);

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
  const LabelledFrame* frame_ = nullptr;
  std::uint64_t number_ = 0;
  Image<Cell> cell_;
  Image<Around> around_;
};

/// The median of some depths.
struct RobustDepth {
  std::size_t count = 0;
  double median = 0;  ///< metres
  double spread = 0;  ///< metres: 1.4826 * median absolute deviation
};

class TrustedDepths {
 public:
  /// Takes the depths of an extent that are labelled clear or front, that may not be of the robot
  /// and that lie within the limits of the expected depth. The extent has one pixel at least.
  void take(const LabelledFrame& frame, std::span<const RowSpan> spans,
            const ExpectedDepth& expected, RobotSurroundings& robot);

  [[nodiscard]] std::size_t count() const { return count_; }

  /// Of the depths taken, of which there are some; may be called once.
  [[nodiscard]] RobustDepth robust();

 private:
  std::vector<std::int32_t> bits_;  // of floats
  std::vector<std::int32_t> scratch_;
  std::size_t count_ = 0;
};

}  // namespace penumbra
