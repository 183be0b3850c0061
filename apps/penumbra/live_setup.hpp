// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <apps/penumbra/live_arguments.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/live/live_inbox.hpp>
#include <io/ros/name_resolver.hpp>

namespace penumbra::app {

/// Names on the graph by --namespace and --remap. Throws InputError.
[[nodiscard]] io::NameResolver live_names(const LiveArguments& arguments);

inline constexpr const char* diagnostics_topic = "/diagnostics";

/// Returns the name and hardware id of this program's diagnostics.
[[nodiscard]] io::DiagnosticSource diagnostic_source(const io::NameResolver& names);

/// Returns the topic of a camera's result before it is resolved. `camera`: empty for the only one.
[[nodiscard]] std::string result_name(const std::string& camera, const io::ResultTopic& topic);

/// Returns the topics of a sensor's clouds without the robot, labelled ones and targets before they
/// are resolved. `topic`: the input's.
[[nodiscard]] std::array<std::string, 3> cloud_result_names(const std::string& topic);

/// Returns the topic of the verdicts over all cameras before it is resolved.
[[nodiscard]] std::string target_views_name();

/// Throws InputError for a remapped name that no topic has, and for results with one name. Call it
/// after all names are resolved.
void check_remaps(const io::NameResolver& names, const std::vector<io::CameraInputOptions>& cameras,
                  const std::vector<io::CloudInputOptions>& clouds);

/// Returns all options but the cameras. Throws InputError for the file of the robot.
[[nodiscard]] io::LiveOptions live_options(const LiveArguments& arguments,
                                           const io::NameResolver& names);

}  // namespace penumbra::app
