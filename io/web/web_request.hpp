// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <io/web/web_types.hpp>

namespace penumbra::io {

/// Parses path and query of a request's target ("/api/x?with=a%2Cb"). Returns nothing if it is
/// invalid: no '/' at its start, '%' without two digits, or control characters, also encoded ones.
[[nodiscard]] std::optional<WebRequest> parse_target(std::string_view target);

}  // namespace penumbra::io
