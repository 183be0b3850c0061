// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace penumbra::app {

/// A bar on stderr with frames done, rate and time left, if stderr is a terminal.
class Progress {
 public:
  explicit Progress(std::size_t total);  ///< 0: unknown
  ~Progress();                           ///< removes the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(Clock::time_point now) const;

  std::size_t total_;
  std::size_t done_ = 0;
  bool visible_;
  Clock::time_point start_;
  Clock::time_point next_draw_;
};

}  // namespace penumbra::app
