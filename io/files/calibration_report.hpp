// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::io {

/// Returns calibration.json. `input`: as the user named it.
[[nodiscard]] std::string calibration_json(const std::string& input, const Calibration& found,
                                           const Robot& robot, const std::string& camera_parent);

}  // namespace penumbra::io
