// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::app {

/// The parts between separators; one empty part of an empty text.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// A value with `digits` after the point.
[[nodiscard]] std::string fixed(double value, int digits);

/// Makes a pipeline; a fault of the lens is blamed on the camera_info file.
[[nodiscard]] Pipeline make_pipeline(Robot robot, const Camera& camera,
                                     const PipelineConfig& config,
                                     const std::filesystem::path& camera_info);

/// Prints Robot::notes() on stderr, a line each.
void tell_notes(const Robot& robot);

}  // namespace penumbra::app
