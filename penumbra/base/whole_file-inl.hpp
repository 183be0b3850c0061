// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace penumbra {

/// The largest sizes of input files, bytes. Bags and images may be larger.
struct FileLimit {
  static constexpr std::uint64_t text = 16U << 20U;  ///< URDF, YAML, package.xml, camera pose
  static constexpr std::uint64_t data = 1U << 30U;   ///< meshes, CSV tables, reports
};

/// Returns the content of a regular file. Throws InputError with the file's name if it cannot be
/// read, is a folder, pipe or device, or is larger than `most_bytes`.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file,
                                          std::uint64_t most_bytes);

}  // namespace penumbra
