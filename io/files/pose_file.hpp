// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <Eigen/Geometry>

namespace penumbra::io {

/// Reads a pose, metres: four rows of four numbers, the last row 0, 0, 0, 1; or the first three
/// rows; or one row x y z qx qy qz qw, of 12 or of 16 numbers, by rows; in text (commas or blanks
/// between, lines with # are comments) or, but for x y z qx qy qz qw, in a NumPy file. Or YAML or
/// JSON of x, y, z, qx, qy, qz, qw (easy_handeye), or of a position or translation and an
/// orientation or rotation (easy_handeye2, ROS messages). A rotation that is off by no more than
/// 1e-4 in any element is projected to the nearest one, one that is off by rounding stays as it is.
/// Throws InputError for anything else.
[[nodiscard]] Eigen::Isometry3d read_pose_csv(const std::filesystem::path& file);

/// Writes a pose that read_pose_csv reads. Throws InputError if the file cannot be written.
void write_pose_csv(const std::filesystem::path& file, const Eigen::Isometry3d& pose);

/// Returns the command of ROS 2 that publishes a pose in TF.
[[nodiscard]] std::string static_transform_command(const Eigen::Isometry3d& T_parent_child,
                                                   const std::string& parent,
                                                   const std::string& child);

}  // namespace penumbra::io
