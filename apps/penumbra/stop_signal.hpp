// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>

namespace penumbra::app {

/// Ctrl-C or SIGTERM as something that one waits for, in place of the end of the program. Made by
/// the main thread before any other thread, which all inherit that these signals wait.
class StopSignal {
 public:
  StopSignal();

  /// Whether one came, before or within this time. From one thread at a time.
  [[nodiscard]] bool wait(std::chrono::nanoseconds at_most);
  [[nodiscard]] bool wait_until(std::chrono::steady_clock::time_point end);

 private:
  sigset_t signals_{};
  bool came_ = false;
};

}  // namespace penumbra::app
