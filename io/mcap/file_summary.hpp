// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <io/mcap/definitions.hpp>
#include <io/mcap/file_window.hpp>

namespace penumbra::io::mcap {

/// The summary after the data section, which makes it unnecessary to read the whole file.
struct FileSummary {
  std::uint64_t start = 0;  ///< offset of the summary's first record
  Definitions definitions;
  std::optional<Statistics> statistics;
  std::vector<ChunkIndexRecord> chunks;  ///< by offset; within the data, no overlaps
};

/// Returns the footer, the last record of a complete file, or nothing if the file is truncated.
[[nodiscard]] std::optional<FooterRecord> read_footer(FileWindow& window);

/// Reads the summary that the footer points to. Returns nothing if there is none, or if it is
/// damaged, which is a fault. `data_begin`: end of the file's header.
[[nodiscard]] std::optional<FileSummary> read_summary(FileWindow& window,
                                                      const FooterRecord& footer,
                                                      std::uint64_t data_begin, FaultLog& faults);

}  // namespace penumbra::io::mcap
