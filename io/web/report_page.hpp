// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra::io {

/// How a report's page begins. A file that begins otherwise is not replaced.
inline constexpr std::string_view report_page_start = "<!doctype html>\n<!-- penumbra run -->\n";

/// Longer reports are more than a browser shows well.
inline constexpr std::size_t most_report_page_bytes = std::size_t{64} << 20U;

/// Returns the page of a run, one file: the built-in template with report.json and the key frames
/// (KeyFrames::json) in it.
[[nodiscard]] std::string report_page(std::string_view report, std::string_view key_frames);

}  // namespace penumbra::io
