// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <io/files/disk_file.hpp>
#include <io/mcap/definitions.hpp>

namespace penumbra::io::mcap {

/// Where messages lie: a chunk, or a stretch of records outside of chunks.
struct MessagePlace {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;      ///< of the whole chunk record, or of the stretch
  std::uint64_t start_time = 0;  ///< earliest log time, as the file says
  bool loose = false;            ///< a stretch outside of chunks
  bool channels_told = false;    ///< whether `channels` are all that have messages here
  std::vector<std::uint16_t> channels;
};

struct FileLayout {
  HeaderRecord header;
  Definitions definitions;  ///< those that stand outside of chunks
  std::optional<Statistics> statistics;
  bool summary_has_channels = false;
  std::vector<MessagePlace> places;  ///< by offset
};

/// Finds everything in an MCAP file behind its magic: by its index and by looking at what the index
/// passes over, or, without one, from record to record. What is damaged or cut is told as a fault.
[[nodiscard]] FileLayout read_layout(const InputFile& file, FaultLog& faults);

}  // namespace penumbra::io::mcap
