// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <penumbra/planning/look_ahead.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::io {

/// Reads poses of cameras: a CSV file with the columns name, x, y, z, qx, qy, qz, qw and, unless
/// all poses are in the root link, link. Metres; the pose is that of the optical frame. Throws
/// InputError that names file and line for columns that are missing, unknown or doubled, for values
/// that are no pose, names that are empty or used twice, and unknown links; and for a file without
/// candidates. `camera`: at each pose.
[[nodiscard]] std::vector<ForecastCamera> read_candidates(const std::filesystem::path& file,
                                                          const Robot& robot,
                                                          const ForecastCamera& camera);

}  // namespace penumbra::io
