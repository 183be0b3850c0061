// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/calibration/calibration.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Returns calibration.json.
[[nodiscard]] std::string calibration_json(const Calibration& found, const Robot& robot,
                                           const std::string& camera_parent);

/// Draws the depth of a frame in grey with the robot's outline at two camera poses: `before` in
/// red, if there is one, and the found one in green.
[[nodiscard]] Image<Rgb8> draw_calibration(const CalibrationFrame& frame, const Intrinsics& camera,
                                           const Robot& robot, const std::string& camera_parent,
                                           const std::optional<Eigen::Isometry3d>& before,
                                           const Calibration& found);

}  // namespace penumbra::io
