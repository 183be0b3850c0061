// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace penumbra::sim {

/// The root link of each arm.
inline constexpr const char* arm_root = "base_link";

/// One of several arms of the same URDF.
struct ArmPlace {
  std::string name;
  Eigen::Isometry3d T_world_root = Eigen::Isometry3d::Identity();
};

/// Returns two places so near that the arms reach through one another.
[[nodiscard]] std::vector<ArmPlace> two_places();

/// Writes one URDF of all arms with a root link "world", for MuJoCo. Names are as Robot::join makes
/// them. Returns the file.
[[nodiscard]] std::filesystem::path write_arms(const std::filesystem::path& urdf,
                                               const std::vector<ArmPlace>& arms,
                                               const std::filesystem::path& folder);

}  // namespace penumbra::sim
