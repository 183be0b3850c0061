// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include <apps/penumbra/arguments.hpp>

namespace penumbra::app {

// What the texts of options mean. All throw InputError that names the option and what is wanted.

[[noreturn]] void refuse_option(const std::string& option, const std::string& value,
                                const std::string& wanted);

[[nodiscard]] Backend to_backend(const std::string& name);
[[nodiscard]] Geometry to_geometry(const std::string& name);
[[nodiscard]] ImageSpace to_image(const std::string& name);
[[nodiscard]] PoseSource to_poses(const std::string& name);
[[nodiscard]] double to_fps(const std::string& text);          ///< 1/s
[[nodiscard]] double to_time_offset(const std::string& text);  ///< seconds
[[nodiscard]] bool to_paper(const std::string& name);
[[nodiscard]] Tolerance to_tolerance(const std::string& text);
[[nodiscard]] int to_count(const std::string& option, const std::string& text, int least, int most);
[[nodiscard]] io::FrameRange to_range(const std::string& text);
[[nodiscard]] io::Saves to_saves(const std::string& text);

/// Splits NAME=VALUE at the first '='.
[[nodiscard]] std::pair<std::string, std::string> to_pair(const std::string& option,
                                                          const std::string& text,
                                                          const std::string& wanted);
[[nodiscard]] std::pair<std::string, double> to_joint(const std::string& text);

/// Adds NAME=DIR, a folder that is there, under a name that is not there yet.
void take_package(const std::string& text, std::map<std::string, std::filesystem::path>& packages);

}  // namespace penumbra::app
