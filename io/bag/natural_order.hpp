// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra::io {

/// Orders file names by their numbers: bag_2 before bag_10.
[[nodiscard]] inline bool natural_less(const std::filesystem::path& left,
                                       const std::filesystem::path& right) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  // Removes the leading digits and returns them without leading zeros.
  const auto take_digits = [&](std::string_view& rest) {
    std::size_t end = 0;
    while (end < rest.size() && is_digit(rest[end])) ++end;
    std::string_view digits = rest.substr(0, end);
    rest.remove_prefix(end);
    while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
    return digits;
  };
  const std::string a_text = left.string(), b_text = right.string();
  std::string_view a = a_text, b = b_text;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view m = take_digits(a), n = take_digits(b);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() != b.size() ? a.size() < b.size() : a_text < b_text;
}

}  // namespace penumbra::io
