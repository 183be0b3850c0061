// SPDX-License-Identifier: Apache-2.0
// Cameras without distortion, and where one is from another.
#pragma once

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>

namespace penumbra::test {

inline Eigen::Isometry3d pose(double x, double y, double z, double angle = 0.0,
                              const Eigen::Vector3d& axis = Eigen::Vector3d::UnitY()) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  T.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return T;
}

inline Camera plain_camera(int width, int height, double focal) {
  return {.intrinsics = Intrinsics(width, height, focal, 1.02 * focal, 0.48 * width, 0.53 * height),
          .distortion = {},
          .range = {},
          .frame_id = {}};
}

}  // namespace penumbra::test
