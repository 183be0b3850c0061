// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::detail {

/// Finds the files that a robot description names: package://NAME/..., model://NAME/...,
/// file://..., and paths relative to the URDF's folder.
///
/// A package that was not given is searched in AMENT_PREFIX_PATH, ROS_PACKAGE_PATH and Gazebo's
/// model paths, then next to the URDF and next to each folder above it. If it is nowhere, NAME may
/// be the only folder of that name in meshes/ or meshes/MODEL/ of the URDF's package.
class FileLocator {
 public:
  FileLocator(std::filesystem::path folder, std::map<std::string, std::filesystem::path> packages)
      : folder_(std::move(folder)), packages_(std::move(packages)) {}

  /// Returns the file's path, which exists. Throws InputError that names the URI, the places that
  /// were searched and a remedy.
  [[nodiscard]] std::filesystem::path locate(const std::string& uri);

  /// Returns a package's folder. Throws InputError likewise.
  [[nodiscard]] std::filesystem::path find_package(const std::string& name) {
    return package_folder(name, "");
  }

  /// One line for each package that was found by a search.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::filesystem::path locate_in_package(const std::string& uri, std::string_view rest);
  std::filesystem::path package_folder(const std::string& name, const std::filesystem::path& file);
  std::pair<std::filesystem::path, std::string> search(const std::string& name,
                                                       const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  std::map<std::string, std::filesystem::path> packages_;  // given or found
  std::vector<std::string> notes_;
};

}  // namespace penumbra::detail
