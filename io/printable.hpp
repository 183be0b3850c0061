// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::io {

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
