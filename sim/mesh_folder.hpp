// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace penumbra::sim {

/// The folder of a URDF's package as it stands beside a bag, where package://NAME/... is found.
class MeshFolder {
 public:
  /// `description`: the package's folder. Throws InputError where something else of its name stands
  /// beside `bag`; touches nothing.
  MeshFolder(std::filesystem::path description, const std::filesystem::path& bag);

  /// Puts it there whole, unless it is there. Throws InputError where the system refuses.
  void copy() const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void check() const;

  std::filesystem::path description_;
  std::filesystem::path path_;
};

}  // namespace penumbra::sim
