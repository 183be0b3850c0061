// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "real_frames.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

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

[[nodiscard]] inline double uniform(std::mt19937_64& random, double low = 0.0, double high = 1.0) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Where a pixel's ray meets an object's surface.
struct SurfaceHit {
  double depth;   ///< metres; not finite if the ray runs along the surface
  double inside;  ///< metres from the outline, positive inside
};

/// Puts an object's surface into a frame's measured depth, pixel by pixel, and takes it out again.
class MeasuredPaste {
 public:
  /// Measured pixels of the object (v * width + u): `edge` pixels or more inside its outline, and
  /// the band between.
  struct Pixels {
    std::vector<int> core, band;
  };

  MeasuredPaste(const SensorModel& model, std::mt19937_64::result_type seed);

  /// Starts another object, with other noise.
  void begin();

  void add(RealFrame& frame, const SurfaceHit& hit, int u, int v);

  /// Puts back what was there.
  void undo(RealFrame& frame);

  [[nodiscard]] std::mt19937_64& random() { return random_; }
  [[nodiscard]] const Pixels& on_robot() const { return on_robot_; }
  [[nodiscard]] const Pixels& beside() const { return beside_; }  ///< outside of the silhouette

 private:
  [[nodiscard]] double noise(double z, int u, int v);

  SensorModel model_;
  std::mt19937_64 random_;
  Image<float> patches_;  // of spread 1, repeated over the plane
  int shift_u_ = 0, shift_v_ = 0;
  Pixels on_robot_, beside_;
  std::vector<std::pair<int, std::uint16_t>> before_;
};

}  // namespace penumbra::test
