// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include <penumbra/base/stamps.hpp>
#include <penumbra/robot/copy_evidence.hpp>
#include <penumbra/robot/stamped_track.hpp>

namespace penumbra {

/// One of several sources that tell a value over time: see ToldTrack.
template <typename Value>
struct ToldSource {
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

  /// Nanoseconds for which a silent source is remembered however short the history is: longer than
  /// a slow driver's time between two states.
  static constexpr std::int64_t shortest_history = 2'000'000'000;

  std::uint32_t number;
  StampedTrack<Value> track;
  std::int64_t began;        ///< its first stamp
  std::uint64_t period = 0;  ///< between its last two states; 0: it told one
  /// Since it was last heard: the stamp of the first state of another one that missed it, and the
  /// stamp from which another one may tell.
  std::int64_t missed_since = never, succeeded = never;
  CopyEvidence evidence{};
  std::optional<Value> weighed{};  ///< the last value that was evidence

  [[nodiscard]] bool is_copy() const { return evidence.is_copy(); }
  [[nodiscard]] std::int64_t end() const { return track.states().back().stamp; }

  /// Whether it is silent at a stamp, up to which it told nothing since `last`.
  [[nodiscard]] bool is_silent(std::int64_t max_gap, std::int64_t last, std::int64_t stamp) const {
    const std::uint64_t due =
        period == 0 ? static_cast<std::uint64_t>(shortest_history) : 2 * period;
    return last < stamp &&
           stamp_distance(last, stamp) > std::max(due, static_cast<std::uint64_t>(max_gap));
  }
};

}  // namespace penumbra
