// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/process_memory.hpp"

#include <chrono>
#include <cstddef>
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

/// `penumbra live` as long as this lives.
class LiveProgram {
 public:
  /// `log`: takes stdout and stderr; empty: they are the test's.
  explicit LiveProgram(std::vector<std::string> arguments, const std::filesystem::path& log = {});
  LiveProgram(const LiveProgram&) = delete;
  LiveProgram& operator=(const LiveProgram&) = delete;
  ~LiveProgram() { static_cast<void>(end()); }

  [[nodiscard]] ProcessUsage usage() const;

  /// Ends it by SIGTERM; its exit status.
  int end();

 private:
  pid_t pid_ = -1;
  int status_ = -1;
};

}  // namespace penumbra::test
