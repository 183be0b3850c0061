// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra::io {

/// The start of a report page. A file with another start is not replaced.
inline constexpr std::string_view report_page_start = "<!doctype html>\n<!-- penumbra run -->\n";

/// The largest report, because browsers do not show larger pages well.
inline constexpr std::size_t most_report_page_bytes = std::size_t{64} << 20U;

/// Returns the page of a run as one file: the built-in template with report.json and the key frames
/// (KeyFrames::json).
[[nodiscard]] std::string report_page(std::string_view report, std::string_view key_frames);

}  // namespace penumbra::io
