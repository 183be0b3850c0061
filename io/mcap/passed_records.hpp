// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <io/mcap/file_window.hpp>
#include <io/mcap/record_format.hpp>

namespace penumbra::io::mcap {

/// What is wrong with a record of the data that the reader does not need, at `offset`; nothing: it
/// may be passed over. A flipped bit of its kind's number would hide a chunk else.
[[nodiscard]] std::string fault_of_passed(const RecordHead& head, std::uint64_t offset,
                                          FileWindow& window);

}  // namespace penumbra::io::mcap
