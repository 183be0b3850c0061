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

/// Where a point in the optical frame is seen; nothing where the camera cannot see it.
[[nodiscard]] std::optional<Eigen::Vector2d> seen_at(const Eigen::Vector3d& p,
                                                     const Camera& camera);

/// Where camera and links are while a frame is drawn, and where they were when a target was seen:
/// in another frame, if it came late.
struct TargetPoses {
  std::optional<Eigen::Isometry3d> T_root_camera;       ///< of the frame that is drawn
  std::optional<Eigen::Isometry3d> T_root_camera_then;  ///< of the target's
  std::span<const Eigen::Isometry3d> T_root_link_then;
  bool is_late = false;
};

/// Lines to draw of a target: borders of its region, edges of its box, the convex outline of its
/// mesh. Empty where nothing of it can be drawn.
[[nodiscard]] std::vector<PixelPath> outline_of(const TargetShape& shape, const TargetPoses& poses,
                                                const Robot& robot, const Camera& camera);

}  // namespace penumbra::io
