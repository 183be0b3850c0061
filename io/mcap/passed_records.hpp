// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <io/mcap/file_window.hpp>
#include <io/mcap/record_format.hpp>

namespace penumbra::io::mcap {

/// Returns what is wrong with a record at `offset` that the reader does not need, or an empty text
/// if it may be skipped. Without this check, a flipped bit in a record's kind could hide a chunk.
[[nodiscard]] std::string fault_of_passed(const RecordHead& head, std::uint64_t offset,
                                          FileWindow& window);

}  // namespace penumbra::io::mcap
