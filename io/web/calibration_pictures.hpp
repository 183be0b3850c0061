// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <penumbra/calibration/calibration.hpp>

#include <io/web/report_page.hpp>

namespace penumbra::io {

/// Returns pictures of the first frames' depth, or masks, with the robot at the first guess, if
/// there is one, and at the result.
[[nodiscard]] std::vector<PagePicture> calibration_pictures(std::span<const KeptFrame> frames,
                                                            const Intrinsics& camera,
                                                            const Robot& robot,
                                                            const CalibrationOptions& options,
                                                            const Calibration& found);

}  // namespace penumbra::io
