// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace penumbra::io {

/// Returns the end of a message about an unknown name: similar known names ("; did you mean
/// joint1, joint2?"), or all if they are few.
[[nodiscard]] std::string near_names(std::string_view name,
                                     std::span<const std::string_view> known);

/// Throws InputError unless a camera, a robot, a body or a target may have this name: names are
/// printed on terminals and in pages.
void check_name(std::string_view name);

/// The same for a camera, whose results are a folder of this name.
void check_camera_name(std::string_view name);

/// Returns the path of an input as reports give it: absolute if it is ".", which names nothing.
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

/// Returns a text as one word for a shell, without control characters.
[[nodiscard]] std::string for_shell(const std::string& text);

}  // namespace penumbra::io
