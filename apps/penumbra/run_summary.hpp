// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/run/judging.hpp>

namespace penumbra::app {

/// Prints what was wrong with frames, targets and overlays, and the robot's notes and the run's, on
/// stderr; counts and times, and where the results are, on stdout.
void tell_result(const io::RunResult& result, const Robot& robot, const std::string& where);

}  // namespace penumbra::app
