// SPDX-License-Identifier: Apache-2.0
// Depths that cannot be the robot's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <penumbra/targets/extent_tally.hpp>

namespace penumbra {

/// Depths near the robot that may be its own: the sensor blurs its edges, and calibration moves
/// them. Computed on demand for cells of LabelRule::cell pixels squared.
class RobotSurroundings {
 public:
  /// `has_outside`: pixels that cannot be rendered are outside the camera's view (rectified
  /// images); else the robot may be there.
  RobotSurroundings(int width, int height, const LabelRule& rule, bool has_outside);

  /// Sets the frame's images, which are read until the next call.
  void begin(const LabelledImages& images);

  /// Depths that may be the robot's within edge_margin pixels of a cell; none if from > to.
  struct Depths {
    float from = std::numeric_limits<float>::infinity(), to = 0;
    [[nodiscard]] bool hold(float d) const { return from <= d && d <= to; }
  };
  [[nodiscard]] const Depths& around(int cell_u, int cell_v);

  /// Distance in pixels within which the robot affects a region.
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

  int cells_;  // margin in cells
  float beyond_factor_;
  labelling::Rule rule_;
  bool has_outside_;
  const LabelledImages* images_ = nullptr;
  std::uint64_t number_ = 0;
  Image<Cell> cell_;
  Image<Around> around_;
};

}  // namespace penumbra
