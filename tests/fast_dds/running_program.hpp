// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/process_memory.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace penumbra::test {

/// What the kernel says of a process.
struct ProcessUsage {
  std::chrono::steady_clock::time_point when;
  double cpu_seconds = 0.0;  ///< of all threads
  ProcessMemory memory;
};

/// A command of `penumbra` that runs as long as this lives.
class RunningProgram {
 public:
  /// `log`: takes stdout and stderr; empty: they are the test's.
  explicit RunningProgram(std::vector<std::string> arguments,
                          const std::filesystem::path& log = {});
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram() { static_cast<void>(end()); }

  [[nodiscard]] ProcessUsage usage() const;

  /// Ends it by a signal, and returns its exit status.
  int end(int signal = SIGTERM);

 private:
  pid_t pid_ = -1;
  int status_ = -1;
};

}  // namespace penumbra::test
