// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <penumbra/fusion/target_fusion.hpp>
#include <penumbra/pipeline/frame.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Returns the message of a report's targets. `camera_frame`: the optical frame of its images;
/// `root_frame`: the robot's root link. The stamp is 0 for a report without a stamp.
[[nodiscard]] TargetsMessage targets_message(const FrameReport& report,
                                             std::string_view camera_frame,
                                             std::string_view root_frame);

/// Returns the message of a target over several cameras.
[[nodiscard]] TargetViewMessage target_view_message(const FusedTarget& target,
                                                    std::span<const ViewCamera> cameras);

}  // namespace penumbra::io
