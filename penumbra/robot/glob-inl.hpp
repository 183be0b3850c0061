// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace penumbra::detail {

/// Whether the whole text matches: * any run, ? any byte, [a-z] one of a set, [!a-z] none of it.
/// A '[' that is never closed stands for itself. Time is at most |pattern| * |text|.
[[nodiscard]] bool glob_match(std::string_view pattern, std::string_view text);

/// Whether the pattern is a plain name.
[[nodiscard]] inline bool is_plain_name(std::string_view pattern) {
  return pattern.find_first_of("*?[") == std::string_view::npos;
}

}  // namespace penumbra::detail
