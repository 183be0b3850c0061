// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>

namespace penumbra::app {

/// Makes Ctrl-C and SIGTERM events to wait for instead of ending the program. Make it in the main
/// thread before any other thread: threads inherit the blocked signals.
class StopSignal {
 public:
  StopSignal();

  /// Returns whether a signal has come until then. Use one thread at a time.
  [[nodiscard]] bool wait(std::chrono::nanoseconds at_most);
  [[nodiscard]] bool wait_until(std::chrono::steady_clock::time_point end);

 private:
  sigset_t signals_{};
  bool came_ = false;
};

}  // namespace penumbra::app
