// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <io/inputs/input_session.hpp>

namespace penumbra::app {

/// Prints faults of frames, targets and overlays on stderr, each after `of`: "/points: ".
void print_faults(const io::RunResult& result, const std::string& of = {});

/// Prints faults of frames, targets and overlays, and all notes, on stderr; counts, times and the
/// place of the results on stdout.
void print_result(const io::RunResult& result, const Robot& robot, const std::string& where);

}  // namespace penumbra::app
