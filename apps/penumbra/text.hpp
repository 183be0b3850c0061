// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::app {

/// The parts between separators; one empty part of an empty text.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// A value with `digits` after the point.
[[nodiscard]] std::string fixed(double value, int digits);

[[nodiscard]] inline std::chrono::nanoseconds to_duration(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

/// Prints rows of equal length on stdout, columns aligned, without control characters.
void print_table(std::vector<std::vector<std::string>> rows);

/// Makes a pipeline; a fault of the lens is blamed on the camera_info file.
[[nodiscard]] Pipeline make_pipeline(Robot robot, const Camera& camera,
                                     const PipelineConfig& config,
                                     const std::filesystem::path& camera_info);

/// What the user may do about a graphics device that failed.
[[nodiscard]] std::string without_device(const DeviceError& error);

/// Prints on stderr, a line each.
void tell_notes(std::span<const std::string> notes);

}  // namespace penumbra::app
