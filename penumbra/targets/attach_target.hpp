// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

/// Returns the body that carries a target of this name, or null.
[[nodiscard]] const PlacedBody* find_body(const PoseResult& poses, std::string_view name);

/// As Pipeline::attach_target; `poses` and `report`: of the last frame.
[[nodiscard]] AttachedBody attach_target(const Target& target, std::string_view link,
                                         const PoseResult& poses, const TargetReport& report,
                                         const Robot& robot);

}  // namespace penumbra
