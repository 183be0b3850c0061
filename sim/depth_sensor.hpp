// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>

#include <sim/simulation.hpp>

namespace penumbra::sim {

/// Simulates a stereo camera's measurement of a true depth image. The same seed and frame number
/// give the same noise, independent of earlier calls.
class DepthSensor {
 public:
  /// `fx` in pixels. Throws InputError for invalid noise.
  DepthSensor(const DepthNoise& noise, double fx, std::uint64_t seed, std::uint64_t stream);

  /// `truth` in metres along the optical axis, 0 = no surface; `measured` in millimetres.
  void measure(const Image<float>& truth, std::uint64_t frame, Image<std::uint16_t>& measured);

 private:
  void find_sides(const Image<float>& truth);
  void draw_patches(int width, int height, std::uint64_t frame);
  void cut_holes(std::uint64_t frame, Image<std::uint16_t>& measured) const;
  [[nodiscard]] std::uint16_t quantised(double z) const;

  DepthNoise noise_;
  double focal_baseline_;  // pixels x metres
  std::uint64_t seed_, stream_;
  std::vector<float> near_, far_, rows_near_, rows_far_;  // nearest and farthest depths
  std::vector<float> lattice_;  // noise shared by patches, at their corners
};

}  // namespace penumbra::sim
