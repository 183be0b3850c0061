// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <penumbra/tracking/pose_tracker.hpp>

#include <sim/experiments/sensed.hpp>

namespace penumbra::sim {

/// Depth along the optical axis at which a ray (z = 1) enters a box about the object's origin;
/// 0 where it passes by.
[[nodiscard]] double box_depth(const Eigen::Isometry3d& T_object_camera,
                               const Eigen::Vector3d& size, const Eigen::Vector3d& ray);

/// The object's pose by the points of both depth cameras that lie at the height of its top near
/// where it is expected; nothing where they do not fill its outline.
[[nodiscard]] std::optional<PoseEstimate> fit_object(const Cell& cell, const Sensed& sensed,
                                                     const Eigen::Isometry3d& expected);

}  // namespace penumbra::sim
