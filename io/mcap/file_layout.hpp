// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <io/files/disk_file.hpp>
#include <io/mcap/definitions.hpp>

namespace penumbra::io::mcap {

/// A place of messages: a chunk, or a range of records outside of chunks.
struct MessagePlace {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;      ///< of the whole chunk record or of the range
  std::uint64_t start_time = 0;  ///< earliest log time, by the file
  bool loose = false;            ///< outside of chunks
  bool channels_known = false;   ///< whether `channels` lists all channels with messages here
  std::vector<std::uint16_t> channels;
};

struct FileLayout {
  HeaderRecord header;
  Definitions definitions;  ///< those outside of chunks
  std::optional<Statistics> statistics;
  bool summary_has_channels = false;
  std::vector<MessagePlace> places;  ///< by offset
};

/// Finds all records in an MCAP file after its magic: by the index and by walking through the parts
/// that are not indexed, or by walking through the file if there is no index. Damage and truncation
/// are reported as faults.
[[nodiscard]] FileLayout read_layout(const InputFile& file, FaultLog& faults);

}  // namespace penumbra::io::mcap
