// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "measured_paste.hpp"
#include "real_frames.hpp"

#include <random>
#include <vector>

namespace penumbra::test {

enum class Shape { square, disc };

/// A flat object that is put before the robot.
struct ObjectKind {
  Shape shape = Shape::square;
  double size = 0.05;  ///< metres: side or diameter
  double tilt = 0.0;   ///< radians between its plane and the image plane
};

/// Pastes objects into a frame's measured depth and takes them out again.
class Paster {
 public:
  Paster(const SensorModel& model, std::mt19937_64::result_type seed);

  /// Puts an object over a random pixel of the robot, turned at random, so that its farthest point
  /// is `gap` metres before the nearest virtual depth under it.
  void paste(RealFrame& frame, const ObjectKind& kind, double gap);

  /// Puts back what was there.
  void undo(RealFrame& frame) { paste_.undo(frame); }

  /// Pixels on the robot (v * width + u) where the object is measured: `edge` pixels or more inside
  /// its outline, and the band between.
  [[nodiscard]] const std::vector<int>& core() const { return paste_.on_robot().core; }
  [[nodiscard]] const std::vector<int>& band() const { return paste_.on_robot().band; }

 private:
  struct Plate;
  [[nodiscard]] Plate place(const RealFrame& frame, const ObjectKind& kind, double gap);

  MeasuredPaste paste_;
};

}  // namespace penumbra::test
