// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sim/experiments/sensed.hpp>

namespace penumbra::sim {

/// Whether the robot's model is drawn on a pixel, whatever was measured there.
[[nodiscard]] inline bool on_silhouette(const Sensed& sensed, int u, int v) {
  const auto& drawn = sensed.robot.virtual_depth.depth;
  return !drawn.empty() && drawn(u, v) > 0;
}

/// How far before the robot's model depths are still removed, metres: depth_distance_threshold as
/// realtime_urdf_filter ships it (github.com/blodow/realtime_urdf_filter,
/// launch/filter_parameters.yaml at 30445756).
inline constexpr double urdf_filter_threshold = 0.05;

/// Whether realtime_urdf_filter removes a pixel on which the robot is drawn: what was measured lies
/// beyond the drawn depth less a threshold (its include/shaders/urdf_filter.frag at 90e4a5f9). It
/// keeps what stands well before the robot, and pixels without measurement.
[[nodiscard]] inline bool urdf_filtered(const Sensed& sensed, int u, int v) {
  constexpr double metres_per_unit = 1e-3;  // of a depth image
  return on_silhouette(sensed, u, v) &&
         sensed.depth(u, v) * metres_per_unit >
             static_cast<double>(sensed.robot.virtual_depth.depth(u, v)) - urdf_filter_threshold;
}

}  // namespace penumbra::sim
