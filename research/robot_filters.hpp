// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <research/cell.hpp>
#include <research/method.hpp>

namespace penumbra::research {

/// Returns whether the robot's model is drawn on a pixel.
[[nodiscard]] inline bool on_silhouette(const Observation& observed, int u, int v) {
  const auto& drawn = observed.robot.virtual_depth.depth;
  return !drawn.empty() && drawn(u, v) > 0;
}

/// Metres in front of the robot's model where depths are still removed: depth_distance_threshold as
/// realtime_urdf_filter ships it (github.com/blodow/realtime_urdf_filter,
/// launch/filter_parameters.yaml at 30445756).
inline constexpr double urdf_filter_threshold = 0.05;

/// Returns whether realtime_urdf_filter removes a pixel: the robot is drawn there, and the measured
/// depth is beyond the drawn depth less a threshold (its include/shaders/urdf_filter.frag at
/// 90e4a5f9).
[[nodiscard]] inline bool urdf_filtered(const Observation& observed, int u, int v) {
  return on_silhouette(observed, u, v) &&
         observed.depth(u, v) * metres_per_unit >
             static_cast<double>(observed.robot.virtual_depth.depth(u, v)) - urdf_filter_threshold;
}

/// Returns whether the point measured at a pixel is above the view's plane (Yoshioka 2021).
[[nodiscard]] inline bool above_plane(const Cell& cell, const View& view, int u, int v) {
  const std::uint16_t depth = view.observed.depth(u, v);
  return depth != 0 &&
         surface_at(cell.camera.intrinsics, cell.T_base_camera, u, v, depth * metres_per_unit).z() >
             view.plane;
}

/// A rule that removes the robot's pixels from a depth image.
struct RobotFilter {
  const char* key;
  const char* name;
  bool (*removes)(const Cell& cell, const View& view, int u, int v);
};

/// research/README.md describes them.
inline constexpr std::array<RobotFilter, 3> robot_filters{
    {{"height", "Height threshold", above_plane},
     {"silhouette", "Silhouette subtraction",
      [](const Cell&, const View& view, int u, int v) {
        return on_silhouette(view.observed, u, v);
      }},
     {"urdf_filter", "URDF filter", [](const Cell&, const View& view, int u, int v) {
        return urdf_filtered(view.observed, u, v);
      }}}};

/// Filters also remove this many pixels around each removed pixel: depth is blurred at edges.
inline constexpr int filter_margin = 3;

/// Returns a detection's mask without the pixels for which `removed(u, v)` is true and those around
/// them.
template <typename Removed>
[[nodiscard]] Image<std::uint8_t> mask_without(const Detection& detection, Removed removed) {
  const Image<std::uint8_t>& mask = detection.mask;
  const PixelBox& box = detection.box;
  Image<std::uint8_t> rest = mask;
  const int u0 = static_cast<int>(box.u), u1 = static_cast<int>(box.u + box.width);
  const int v0 = static_cast<int>(box.v), v1 = static_cast<int>(box.v + box.height);
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) {
      if (mask(u, v) == 0 || !removed(u, v)) continue;
      for (int y = std::max(v - filter_margin, v0); y <= std::min(v + filter_margin, v1 - 1); ++y)
        for (int x = std::max(u - filter_margin, u0); x <= std::min(u + filter_margin, u1 - 1); ++x)
          rest(x, y) = 0;
    }
  return rest;
}

}  // namespace penumbra::research
