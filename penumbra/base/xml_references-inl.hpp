// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace penumbra::detail {

/// The text with XML's five entities and character references in place of what they stand for
/// (XML 1.0, 4.1 and 4.6). Throws InputError, without a place, for any other '&' and for a
/// reference to what is no character of XML, such as control characters.
[[nodiscard]] std::string without_references(std::string_view text);

}  // namespace penumbra::detail
