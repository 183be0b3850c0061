// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <penumbra/pipeline/pose_history.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Adds what a joint state tells.
void add_to_history(const JointStateMessage& message, PoseHistory& history);

/// Adds what a message of /tf or (static) of /tf_static tells.
void add_to_history(const TfMessage& message, bool is_static, PoseHistory& history);

/// What a history has refused, a line each.
[[nodiscard]] std::vector<std::string> refusals_of(const PoseHistory& history);

}  // namespace penumbra::io
