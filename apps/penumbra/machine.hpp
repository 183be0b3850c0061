// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <io/files/machine_report.hpp>

namespace penumbra::app {

/// Asks this machine; what it does not offer is told in the report. Takes a second or so: every
/// OpenGL device is tried.
[[nodiscard]] io::MachineReport examine_machine();

}  // namespace penumbra::app
