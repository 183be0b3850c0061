// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/calibration/calibration.hpp>

namespace penumbra::io {

/// What a calibration was made from.
struct CalibrationOf {
  std::string input;  ///< as the user named it
  std::span<const CalibrationFrame> frames;
  const Intrinsics& camera;
  const Robot& robot;
  const CalibrationOptions& options;
};

/// Returns report.html: one page with the result, residuals by frame and by link, and each frame's
/// depth before and after.
[[nodiscard]] std::string calibration_page(const CalibrationOf& of, const Calibration& found);

}  // namespace penumbra::io
