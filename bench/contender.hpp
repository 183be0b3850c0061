// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "timing.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace penumbra::bench {

/// One way of making frames.
struct Contender {
  std::string name;
  std::function<void(std::size_t)> submit;  ///< takes a frame's index
  std::function<void()> collect;            ///< waits for the oldest frame
  int max_pending = 1;                      ///< frames that may be submitted ahead
};

/// What a contender's frames cost.
struct FrameCosts {
  explicit FrameCosts(std::size_t frames) : blocking(frames) {}

  FrameTimes blocking;  ///< from submit to collect, nothing ahead
  PassCosts waiting;    ///< the same passes
  PassCosts with_frames_ahead;
};

/// Rounds over the frames, the contenders in turn, so that a disturbance meets all of them: each
/// frame awaited, then as many ahead as may be.
[[nodiscard]] std::vector<FrameCosts> measure(const std::vector<Contender>& contenders,
                                              std::size_t frames, int rounds);

/// Prints the head of print_costs' columns.
void print_costs_head(const std::string& title);
/// Prints a row, and gives it as JSON.
nlohmann::json print_costs(const Contender& contender, const FrameCosts& costs);

}  // namespace penumbra::bench
