// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace penumbra::io {

/// Returns the end of a message about an unknown name: similar known names ("; did you mean
/// joint1, joint2?"), or all if they are few.
[[nodiscard]] std::string near_names(std::string_view name,
                                     std::span<const std::string_view> known);

}  // namespace penumbra::io
