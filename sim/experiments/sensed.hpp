// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/occlusion/labels.hpp>
#include <penumbra/occlusion/target_judge.hpp>

namespace penumbra::sim {

/// What is known of a cell before anything moves: every method may use all of it.
struct Cell {
  Camera camera;
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  Camera second_camera;  ///< of the second depth camera
  Eigen::Isometry3d T_base_second_camera = Eigen::Isometry3d::Identity();
  LabelRule rule;                        ///< that labels are made by
  std::size_t links = 0;                 ///< of the robot
  Eigen::Vector3d object_size{0, 0, 0};  ///< metres
  Eigen::Vector3d conveyor_direction{0, 0, 0};
  double floor = 0;         ///< metres: height of the belt (conveyor)
  double reach = 0;         ///< metres: the wrist's true height (handover)
  double wrist_radius = 0;  ///< metres from a wrist's surface to its centre (handover)
};

/// What was measured at one stamp. No truth stands in it: methods see nothing else.
struct Sensed {
  std::int64_t stamp = 0;                       ///< nanoseconds
  ImageView<const std::uint16_t> depth;         ///< millimetres, 0 = nothing
  ImageView<const std::uint16_t> second_depth;  ///< of the second camera
  JudgedImages robot;  ///< Penumbra's virtual depth and labels; `labels` are for our method only
};

/// Where the surface seen at a pixel lies in the base frame.
[[nodiscard]] inline Eigen::Vector3d surface_at(const Intrinsics& camera,
                                                const Eigen::Isometry3d& T_base_camera, double u,
                                                double v, double depth) {
  return T_base_camera * (camera.ray(u, v) * depth);
}

}  // namespace penumbra::sim
