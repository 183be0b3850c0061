// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::io {

using PixelPath = std::vector<Eigen::Vector2d>;

/// Returns the pixel of a point in the optical frame, or nothing if the camera cannot see it.
[[nodiscard]] std::optional<Eigen::Vector2d> seen_at(const Eigen::Vector3d& p,
                                                     const Camera& camera);

/// Poses of the drawn frame and of the target's frame, which is another one if the target is late.
struct TargetPoses {
  std::optional<Eigen::Isometry3d> T_root_camera;       ///< of the frame that is drawn
  std::optional<Eigen::Isometry3d> T_root_camera_then;  ///< of the target's
  std::span<const Eigen::Isometry3d> T_root_link_then;
  bool is_late = false;
};

/// Returns lines of a target: borders of its region, edges of its box, the convex outline of its
/// mesh. Empty if it cannot be drawn.
[[nodiscard]] std::vector<PixelPath> outline_of(const TargetShape& shape, const TargetPoses& poses,
                                                const Robot& robot, const Camera& camera);

}  // namespace penumbra::io
