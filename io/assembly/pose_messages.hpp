// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/time/pose_history.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Of a history whose sources are compared, or not.
[[nodiscard]] PoseHistoryOptions history_options(bool compare_sources);

/// Adds what a joint state of `source` (MessageSources) tells; how many of its positions were
/// taken.
std::size_t add_to_history(const JointStateMessage& message, std::string_view source,
                           PoseHistory& history);

/// Adds what a message of /tf or (static) of /tf_static tells.
void add_to_history(const TfMessage& message, bool is_static, std::string_view source,
                    PoseHistory& history);

/// What a history has refused, a line each.
[[nodiscard]] std::vector<std::string> refusals_of(const PoseHistory& history);

}  // namespace penumbra::io
