// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <penumbra/calibration/kept_frames.hpp>

namespace penumbra {

/// Returns a line for each moving link that carries something large that the URDF lacks, from
/// frames with depth, labels and links. Stereo matching leaves most of the fringe near the robot's
/// outline; an undescribed part extends to the fringe's reach, and moves with its link: what stands
/// still next to a link is left out. `fringe_reach`: of the label rule, pixels of the kept images.
[[nodiscard]] std::vector<std::string> missing_parts(std::span<const KeptFrame> frames,
                                                     const Robot& robot, double fringe_reach);

}  // namespace penumbra
