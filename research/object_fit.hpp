// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <penumbra/tracking/trackers.hpp>

#include <research/cell.hpp>

namespace penumbra::research {

/// Returns the depth along the optical axis where a ray (z = 1) enters a box around the object's
/// origin; 0 if it misses the box.
[[nodiscard]] double box_depth(const Eigen::Isometry3d& T_object_camera,
                               const Eigen::Vector3d& size, const Eigen::Vector3d& ray);

/// Fits the object's outline to the points of both depth cameras that are at the height of its top
/// near its expected pose. Returns nothing if they do not fill the outline.
[[nodiscard]] std::optional<PoseEstimate> fit_object(const Cell& cell, const Observation& observed,
                                                     const Eigen::Isometry3d& expected);

}  // namespace penumbra::research
