// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/calibration/calibration.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::io {

/// Returns calibration.json.
[[nodiscard]] std::string calibration_json(const Calibration& found, const Robot& robot,
                                           const std::string& camera_parent);

}  // namespace penumbra::io
