// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <Eigen/Geometry>

namespace penumbra::io {

/// Reads a pose: four rows of four comma-separated numbers, metres, the last row 0, 0, 0, 1. A
/// rotation that is off by no more than 1e-4 in any element is projected to the nearest one. Throws
/// InputError for anything else.
[[nodiscard]] Eigen::Isometry3d read_pose_csv(const std::filesystem::path& file);

}  // namespace penumbra::io
