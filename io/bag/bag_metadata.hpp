// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <io/bag/bag_reader.hpp>

namespace penumbra::io {

/// The metadata.yaml that `ros2 bag record` writes next to a recording's files when it ends.
struct BagMetadata {
  std::vector<std::filesystem::path> files;  ///< in the order of recording; some may be missing
  /// Number of messages by topic and type.
  std::map<std::pair<std::string, std::string>, std::uint64_t> messages;
  std::map<std::pair<std::string, std::string>, OfferedQos> qos;  ///< by topic and type
};

/// Reads a metadata.yaml of any version. Throws InputError with file and line for missing or
/// invalid entries, for recordings without files, and for recordings with compressed files or
/// messages.
[[nodiscard]] BagMetadata read_bag_metadata(const std::filesystem::path& file);

}  // namespace penumbra::io
