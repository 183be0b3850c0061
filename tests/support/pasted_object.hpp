// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "real_frames.hpp"

#include <cstddef>
#include <random>
#include <vector>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

enum class Shape { square, disc };

/// A flat object that is put before the robot.
struct ObjectKind {
  Shape shape = Shape::square;
  double size = 0.05;  ///< metres: side or diameter
  double tilt = 0.0;   ///< radians between its plane and the image plane
};

/// What a depth sensor makes of a surface. Defaults are measured on the xArm recording: the local
/// spread of measured against virtual depth inside smooth parts of the robot is 1 mm x z^2 in
/// windows of 5 pixels and 3 mm x z^2 in windows of 21, half of the frames above and below.
struct SensorModel {
  double patchy = 0.0028;      ///< metres per square metre; Gaussian patches
  double patch_sigma = 4.0;    ///< pixels
  double white = 0.0008;       ///< metres per square metre, pixel by pixel
  double edge = 2.0;           ///< pixels on both sides of the object's outline that may be mixed
  double mixed = 0.3;          ///< share of those that hold a depth between object and background
  double edge_holes = 0.15;    ///< share of those without measurement
  double inside_holes = 0.01;  ///< share of all others of the object without measurement
};

/// Pastes objects into a frame's measured depth and takes them out again.
class Paster {
 public:
  Paster(const SensorModel& model, std::mt19937_64::result_type seed);

  /// Puts an object over a random pixel of the robot, turned at random, so that its farthest point
  /// is `gap` metres before the nearest virtual depth under it.
  void paste(RealFrame& frame, const ObjectKind& kind, double gap);

  /// Puts back what was there.
  void undo(RealFrame& frame);

  /// Pixels on the robot (v * width + u) where the object is measured: `edge` pixels or more inside
  /// its outline, and the band between.
  [[nodiscard]] const std::vector<int>& core() const { return core_; }
  [[nodiscard]] const std::vector<int>& band() const { return band_; }

 private:
  struct Plate;
  [[nodiscard]] Plate place(const RealFrame& frame, const ObjectKind& kind, double gap);
  [[nodiscard]] double noise(double z, int u, int v);
  void paste_pixel(RealFrame& frame, const Plate& plate, int u, int v);

  SensorModel model_;
  std::mt19937_64 random_;
  Image<float> patches_;  // of spread 1, repeated over the plane
  int shift_u_ = 0, shift_v_ = 0;
  std::vector<int> core_, band_;
  std::vector<std::pair<int, std::uint16_t>> before_;
};

}  // namespace penumbra::test
