// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace penumbra::io {

/// How a message ends that names something unknown: the known names that are near to it ("; near
/// are: joint1, joint2"), or all where they are few.
[[nodiscard]] std::string near_names(std::string_view name,
                                     std::span<const std::string_view> known);

}  // namespace penumbra::io
