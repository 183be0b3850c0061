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

/// What `ros2 bag record` writes beside a recording's files when it ends.
struct BagMetadata {
  std::vector<std::filesystem::path> files;  ///< in the order of recording; some may be missing
  /// Messages by topic and type.
  std::map<std::pair<std::string, std::string>, std::uint64_t> messages;
  std::map<std::pair<std::string, std::string>, OfferedQos> qos;  ///< likewise
};

/// Reads metadata.yaml of any version. Throws InputError with file and line for what it does not
/// hold, for recordings without files and for such whose files or messages are compressed by
/// themselves.
[[nodiscard]] BagMetadata read_bag_metadata(const std::filesystem::path& file);

}  // namespace penumbra::io
