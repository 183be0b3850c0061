// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra::research {

inline constexpr double metres_per_unit = 1e-3;  ///< of a depth image
inline constexpr double wrist_radius = 0.036;    ///< metres from the wrist's surface to its centre

/// What is known of a cell before anything moves. Every method may use all of it.
struct Cell {
  Camera camera;  ///< of both cameras
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_base_second_camera = Eigen::Isometry3d::Identity();
  LabelRule rule;
  std::size_t links = 0;                        ///< of the robot
  Eigen::Vector3d object_size{0, 0, 0};         ///< conveyor, metres
  Eigen::Vector3d conveyor_direction{0, 0, 0};  ///< conveyor
  double belt_height = 0;                       ///< conveyor, metres
};

/// What was measured at one stamp. It contains no truth.
struct Observation {
  std::int64_t stamp = 0;                       ///< nanoseconds
  ImageView<const std::uint16_t> depth;         ///< millimetres, 0 = nothing
  ImageView<const std::uint16_t> second_depth;  ///< of the second camera
  LabelledImages robot;  ///< Penumbra's virtual depth and labels; only Penumbra uses the labels
};

/// Returns the point at a pixel and a depth in metres, in the base frame.
[[nodiscard]] inline Eigen::Vector3d surface_at(const Intrinsics& camera,
                                                const Eigen::Isometry3d& T_base_camera, double u,
                                                double v, double depth) {
  return T_base_camera * (camera.ray(u, v) * depth);
}

}  // namespace penumbra::research
