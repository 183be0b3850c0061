// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <initializer_list>
#include <iterator>
#include <string>

namespace penumbra::sim {

/// Returns numbers as text with all their digits.
[[nodiscard]] inline std::string numbers(std::initializer_list<double> values,
                                         const char* separator = " ") {
  std::string text;
  for (const double value : values) {
    char digits[32];
    const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
    text += (text.empty() ? "" : separator) + std::string(digits, end);
  }
  return text;
}

}  // namespace penumbra::sim
