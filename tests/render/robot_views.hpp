// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

/// Loads "ur5e" or "xarm7" from the data folder.
[[nodiscard]] Robot load_robot(const std::string& name, Geometry geometry);

/// One body per link, without the pipeline, which a tree for the renderer's tests leaves out. Valid
/// as long as the robot.
[[nodiscard]] std::vector<Body> link_bodies(const Robot& robot);

/// Where a random camera stands.
enum class ViewKind {
  outside,      ///< 0.6 m to 2.5 m away
  eye_in_hand,  ///< on the last link, looking anywhere
  at_the_skin,  ///< less than 1.2 cm before some surface, which the near plane cuts open
};

/// A camera of random focal length, its principal point up to half an image outside of the image.
[[nodiscard]] Intrinsics random_intrinsics(std::mt19937_64& random, int width, int height);

/// T_camera_link of every link: random joint positions, and a random camera in which some pixel
/// sees the robot, and whose centre is in no link.
[[nodiscard]] std::vector<Eigen::Isometry3d> random_view(std::mt19937_64& random,
                                                         const Robot& robot,
                                                         const std::vector<Body>& bodies,
                                                         const Intrinsics& intrinsics,
                                                         ViewKind kind);

}  // namespace penumbra::test
