// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <io/files/result_folder.hpp>
#include <io/inputs/input_session.hpp>
#include <io/outputs/output_folder.hpp>

namespace penumbra::app {

/// A camera that is named on the command line.
struct NamedCamera {
  std::string name, depth_topic;
};

struct RunArguments {
  io::SessionOptions session;
  io::OutputOptions output;
  std::vector<NamedCamera> cameras = {};  ///< several of a bag
};

/// Judges cameras of a recording, or of a bag if they have a topic, each into OUT/NAME, and writes
/// OUT/views.json. The place of OUT is checked. Returns the exit status.
int run_cameras(const RunArguments& arguments, const std::vector<NamedCamera>& cameras);

// Parts of every run, in run.cpp.

/// Judges all frames, with a bar on the terminal.
[[nodiscard]] io::RunResult judge_all(io::InputSession& session, const io::Sinks& sinks);

/// Removes earlier results.
[[nodiscard]] std::unique_ptr<io::Sink> open_output(const io::OutputOptions& options,
                                                    io::ResultFolder& folder,
                                                    const Pipeline& pipeline);

/// From now on the first Ctrl-C or SIGTERM only makes was_interrupted() true; a second one ends the
/// program.
void catch_interrupts();
[[nodiscard]] bool was_interrupted();
/// Returns the exit status of a program that a signal ended.
[[nodiscard]] int interrupt_status();

[[nodiscard]] int status_of(const io::RunResult& result, bool force);

}  // namespace penumbra::app
