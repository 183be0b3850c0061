// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <io/mcap/definitions.hpp>
#include <io/mcap/file_window.hpp>

namespace penumbra::io::mcap {

/// What the writer put behind its data so that nobody need read it all.
struct FileSummary {
  std::uint64_t start = 0;  ///< offset of its first record
  Definitions definitions;
  std::optional<Statistics> statistics;
  std::vector<ChunkIndexRecord> chunks;  ///< by offset; they do not overlap and lie in the data
};

/// The last record of a whole file; nothing where the file was cut.
[[nodiscard]] std::optional<FooterRecord> read_footer(FileWindow& window);

/// Reads what the footer tells of. Nothing where there is no summary, or a damaged one, which is a
/// fault. `data_begin`: end of the file's header.
[[nodiscard]] std::optional<FileSummary> read_summary(FileWindow& window,
                                                      const FooterRecord& footer,
                                                      std::uint64_t data_begin, FaultLog& faults);

}  // namespace penumbra::io::mcap
