// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra::io {

/// How a page begins: whose it is.
inline constexpr std::string_view report_page_start = "<!doctype html>\n<!-- penumbra run -->\n";
inline constexpr std::string_view experiment_page_start =
    "<!doctype html>\n<!-- penumbra experiment -->\n";

/// Longer reports are more than a browser shows well.
inline constexpr std::size_t most_report_page_bytes = std::size_t{64} << 20U;

/// The page of a run, one file: the built-in template with report.json and the key frames in it
/// (KeyFrames::json).
[[nodiscard]] std::string report_page(std::string_view report, std::string_view key_frames);

/// The page of an experiment, of the same template: metrics.json, what else it shows, and pictures.
[[nodiscard]] std::string experiment_page(std::string_view metrics, std::string_view experiment,
                                          std::string_view key_frames);

/// JSON that a <script> may hold: '<' is written as \u003c.
[[nodiscard]] std::string script_json(std::string_view json);

}  // namespace penumbra::io
