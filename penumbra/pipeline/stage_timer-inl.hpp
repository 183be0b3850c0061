// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

namespace penumbra {

/// Writes the wall time of its scope, milliseconds.
class StageTimer {
 public:
  explicit StageTimer(std::optional<double>& to) : to_(to), start_(Clock::now()) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() { to_ = std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<double>& to_;
  Clock::time_point start_;
};

}  // namespace penumbra
