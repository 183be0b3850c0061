// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <penumbra/planning/look_ahead.hpp>

namespace penumbra::io {

/// A motion of a file.
struct NamedTrajectory {
  std::string name;
  Trajectory trajectory;
};

/// The result of `penumbra look-ahead`. Refers to its parts.
struct LookAheadResult {
  std::string input;      ///< as the user named it
  std::size_t frame = 0;  ///< in which the motions begin
  std::span<const ForecastCamera> cameras;
  std::span<const TargetReport> now;  ///< as the first camera measures them; empty without depth
  std::span<const NamedTrajectory> motions;
  std::span<const std::vector<TargetForecast>> forecasts;  ///< of each motion, by target
  std::span<const RankedMotion> ranking;
  std::span<const std::string> notes;
};

/// Returns the content of look_ahead.json.
[[nodiscard]] std::string look_ahead_json(const LookAheadResult& result);

}  // namespace penumbra::io
