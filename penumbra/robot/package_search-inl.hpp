// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::detail {

/// The folders in an environment variable that are parted by ':'; empty if it is not set.
[[nodiscard]] std::vector<std::filesystem::path> folders_in(const char* variable);

/// The <name> of a folder's package.xml; nothing if there is none or it cannot be read.
[[nodiscard]] std::optional<std::string> package_name(const std::filesystem::path& folder);

/// Every package below the folders of ROS_PACKAGE_PATH by its name, and by its folder's name. The
/// first found wins; folders inside a package, hidden ones and those marked by a *_IGNORE file are
/// not searched.
[[nodiscard]] std::map<std::string, std::filesystem::path> crawl_ros_packages();

/// Folders that may be package `name`, nearest first: NAME beside the URDF's folder and beside each
/// folder above it, and those folders themselves if they are called NAME or hold its package.xml.
[[nodiscard]] std::vector<std::filesystem::path> folders_near(const std::filesystem::path& start,
                                                              const std::string& name);

}  // namespace penumbra::detail
