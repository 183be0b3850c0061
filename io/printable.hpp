// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::io {

/// Whether a character ends a line or steers a terminal.
[[nodiscard]] constexpr bool is_control(char c) { return (c >= 0 && c < ' ') || c == 127; }

/// A foreign text for a message of one line: question marks for what is no visible ASCII, cut after
/// 80 characters.
[[nodiscard]] inline std::string printable(std::string_view text) {
  constexpr std::size_t longest = 80;
  std::string shown(text.substr(0, longest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return text.size() > longest ? shown + "..." : shown;
}

}  // namespace penumbra::io
