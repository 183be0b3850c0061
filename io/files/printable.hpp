// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::io {

/// Returns whether a character ends a line or controls a terminal.
[[nodiscard]] constexpr bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == 127;
}

/// Returns a foreign text for a message of one line: question marks for everything but visible
/// ASCII, cut after 80 characters.
[[nodiscard]] inline std::string printable(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return text.size() > longest ? shown + "..." : shown;
}

/// Returns a text for a table or a note: question marks for control characters, C1 in UTF-8 too.
[[nodiscard]] inline std::string without_controls(std::string_view text) {
  std::string shown(text);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (is_control(shown[i])) shown[i] = '?';
    const bool may_be_c1 = shown[i] == '\xC2' && i + 1 < shown.size();
    if (may_be_c1 && static_cast<unsigned char>(shown[i + 1]) < 0xA0) shown.replace(i, 2, "?");
  }
  return shown;
}

}  // namespace penumbra::io
