// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <apps/penumbra/arguments.hpp>
#include <io/assembly/result_encoder.hpp>
#include <io/live/live_diagnostics.hpp>
#include <io/live/live_inbox.hpp>
#include <io/live/name_resolver.hpp>

namespace penumbra::app {

/// Names on the graph by --namespace and --remap. Throws InputError.
[[nodiscard]] io::NameResolver live_names(const LiveArguments& arguments);

inline constexpr const char* diagnostics_topic = "/diagnostics";

/// As whom it speaks there.
[[nodiscard]] io::DiagnosticSource diagnostic_source(const io::NameResolver& names);

/// Of a camera's result, before it is resolved; `camera`: its name, empty for the only one.
[[nodiscard]] std::string result_name(const std::string& camera, const io::ResultTopic& topic);

/// To be called when all else is resolved: throws InputError for a name that is remapped and that
/// nothing has.
void check_remaps(const io::NameResolver& names,
                  const std::vector<io::CameraInputOptions>& cameras);

/// All but the cameras. Throws InputError of a robot's file.
[[nodiscard]] io::LiveOptions live_options(const LiveArguments& arguments,
                                           const io::NameResolver& names);

}  // namespace penumbra::app
