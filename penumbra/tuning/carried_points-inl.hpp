// SPDX-License-Identifier: Apache-2.0
// The measure of docs/tuning.md.
#pragma once

#include <cmath>

#include <penumbra/tuning/nearest_pixel-inl.hpp>

namespace penumbra::tuning {

inline constexpr double carried_pixels = 40.0;  ///< from the outline
inline constexpr double carried_depth = 0.10;   ///< metres from the virtual depth of the outline

/// Returns whether a point measured outside the robot's outline counts as the robot's, carried past
/// the outline by the sensor. `nearest`: of the robot's pixels. `z`: metres, > 0.
inline bool is_carried(const NearestPixels& nearest, ImageView<const float> virtual_depth, int u,
                       int v, double z) {
  if (nearest.distance(u, v) > carried_pixels) return false;
  const auto at = nearest.at(u, v);
  return std::abs(z - static_cast<double>(virtual_depth(at.u, at.v))) <= carried_depth;
}

}  // namespace penumbra::tuning
