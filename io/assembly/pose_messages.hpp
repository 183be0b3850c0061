// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/time/pose_history.hpp>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// Returns the options of a history that compares its sources or not.
[[nodiscard]] PoseHistoryOptions history_options(bool compare_sources);

/// Adds a joint state of `source` (see MessageSources). Returns the number of positions used.
std::size_t add_to_history(const JointStateMessage& message, std::string_view source,
                           PoseHistory& history);

/// Adds a message of /tf, or of /tf_static if `is_static`.
void add_to_history(const TfMessage& message, bool is_static, std::string_view source,
                    PoseHistory& history);

/// Returns the messages that a history refused, one line each.
[[nodiscard]] std::vector<std::string> refusals_of(const PoseHistory& history);

}  // namespace penumbra::io
