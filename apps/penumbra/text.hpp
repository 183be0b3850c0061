// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/text.hpp>

namespace penumbra::app {

/// Returns the parts between separators: one empty part for an empty text.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

using detail::fixed;

[[nodiscard]] inline std::chrono::nanoseconds to_duration(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

/// Prints rows of equal length on stdout, columns aligned, without control characters.
void print_table(std::vector<std::vector<std::string>> rows);

/// Prints a line on stdout.
void print_line(const std::string& line);

/// Prints one line on stderr, without control characters: foreign texts come as they are.
void print_error(std::string message, std::string_view from = "penumbra: ");

/// Prints notes on stderr, a line each.
void print_notes(std::span<const std::string> notes);

}  // namespace penumbra::app
