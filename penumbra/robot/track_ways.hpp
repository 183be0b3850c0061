// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include <penumbra/base/stamps.hpp>
#include <penumbra/robot/stamped_track.hpp>

namespace penumbra {

// What a track's values do near a stamp, by a rule as ToldTrack has it: double distance(Value,
// Value), Value between(Value, double share, Value).

/// Between two states, which there are.
template <typename Rule, typename Bracket>
[[nodiscard]] auto value_at(const Rule& rule, const Bracket& around, std::int64_t stamp) {
  if (around.before == around.after) return around.before->value;
  const double share = static_cast<double>(stamp_distance(around.before->stamp, stamp)) /
                       static_cast<double>(around.gap());
  return rule.between(around.before->value, share, around.after->value);
}

/// Whether a source tells from `lag` before a stamp on.
template <typename Value>
[[nodiscard]] bool is_known_for(const StampedTrack<Value>& track, std::int64_t stamp,
                                std::uint64_t lag) {
  const std::int64_t first = track.states().front().stamp;
  return first <= stamp && stamp_distance(first, stamp) >= lag;
}

/// Whether a source told nothing between two states for longer than it may, and than it did before:
/// what was lost in between is not known.
template <typename Value>
[[nodiscard]] bool is_pause(const StampedTrack<Value>& track,
                            const typename StampedTrack<Value>::Bracket& around, std::int64_t may) {
  if (around.gap() <= static_cast<std::uint64_t>(may)) return false;
  const auto* const last = track.last_before(around.before->stamp);
  return last == nullptr || around.gap() > 2 * stamp_distance(last->stamp, around.before->stamp);
}

/// How far a source gets from a value there.
template <typename Value, typename Rule>
[[nodiscard]] double travel(const Rule& rule, const StampedTrack<Value>& track, std::int64_t stamp,
                            std::uint64_t lag, const Value& from) {
  double most = 0.0;
  for (const auto& state : track.within(stamp, lag))
    most = std::max(most, rule.distance(state.value, from));
  return most;
}

/// Whether a source told a value from one stamp to another.
template <typename Value, typename Rule>
[[nodiscard]] bool has_told(const Rule& rule, const StampedTrack<Value>& track, std::int64_t from,
                            std::int64_t to, const Value& value) {
  // A float's digits, and an angle's between two equal rotations; no two measurements agree so.
  constexpr double same = 1e-6;  // radians or metres
  const auto told = track.up_to(to);
  for (auto state = told.rbegin(); state != told.rend() && state->stamp >= from; ++state)
    if (rule.distance(state->value, value) <= same) return true;
  return false;
}

}  // namespace penumbra
