// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace penumbra::sim {

/// The folder of a URDF's package next to a bag, where package://NAME/... is found.
class MeshFolder {
 public:
  /// `description`: the package's folder. Throws InputError if something else with its name is next
  /// to `bag`. Writes nothing.
  MeshFolder(std::filesystem::path description, const std::filesystem::path& bag);

  /// Copies the whole folder, unless it is there already. Throws InputError if the system refuses.
  void copy() const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void check() const;

  std::filesystem::path description_;
  std::filesystem::path path_;
};

}  // namespace penumbra::sim
