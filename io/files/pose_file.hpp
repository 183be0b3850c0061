// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <Eigen/Geometry>

namespace penumbra::io {

/// Reads a pose: four rows of four comma-separated numbers, metres, the last row 0, 0, 0, 1. A
/// rotation that is off by no more than 1e-4 in any element is projected to the nearest one, one
/// that is off by rounding stays as it is. Throws InputError for anything else.
[[nodiscard]] Eigen::Isometry3d read_pose_csv(const std::filesystem::path& file);

/// Writes a pose that read_pose_csv reads. Throws InputError if the file cannot be written.
void write_pose_csv(const std::filesystem::path& file, const Eigen::Isometry3d& pose);

}  // namespace penumbra::io
