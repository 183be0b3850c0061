// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <penumbra/camera/camera.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::io {

using PixelPath = std::vector<Eigen::Vector2d>;

/// Where a point in the optical frame is seen; nothing where the camera cannot see it.
[[nodiscard]] std::optional<Eigen::Vector2d> seen_at(const Eigen::Vector3d& p,
                                                     const Camera& camera);

/// Lines to draw of a target: borders of its region, edges of its box, the convex outline of its
/// mesh. Empty where nothing of it can be drawn.
[[nodiscard]] std::vector<PixelPath> outline_of(const TargetShape& shape, const FrameReport& report,
                                                const Robot& robot, const Camera& camera);

}  // namespace penumbra::io
