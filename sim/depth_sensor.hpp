// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>

#include <sim/simulation.hpp>

namespace penumbra::sim {

/// What a stereo camera measures of a true depth image. The same seed and frame number give the
/// same noise, whatever was measured before.
class DepthSensor {
 public:
  /// `fx` in pixels. Throws InputError for noise that makes no sense.
  DepthSensor(const DepthNoise& noise, double fx, std::uint64_t seed, std::uint64_t stream);

  /// `truth` in metres along the optical axis, 0 = nothing; `measured` in millimetres.
  void measure(const Image<float>& truth, std::uint64_t frame, Image<std::uint16_t>& measured);

 private:
  void find_sides(const Image<float>& truth);
  void draw_patches(int width, int height, std::uint64_t frame);
  void cut_holes(std::uint64_t frame, Image<std::uint16_t>& measured) const;
  [[nodiscard]] std::uint16_t quantised(double z) const;

  DepthNoise noise_;
  double focal_baseline_;  // pixels x metres
  std::uint64_t seed_, stream_;
  std::vector<float> near_, far_, rows_near_, rows_far_;  // nearest and farthest depths around
  std::vector<float> lattice_;  // noise that whole patches share, at their corners
};

}  // namespace penumbra::sim
