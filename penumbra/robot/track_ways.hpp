// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

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

/// How far a source gets from a value there.
template <typename Value, typename Rule>
[[nodiscard]] double travel(const Rule& rule, const StampedTrack<Value>& track, std::int64_t stamp,
                            std::uint64_t lag, const Value& from) {
  double most = 0.0;
  for (const auto& state : track.within(stamp, lag))
    most = std::max(most, rule.distance(state.value, from));
  return most;
}

/// How far a value is from the way of a source to a state.
template <typename Value, typename Rule>
[[nodiscard]] double from_path(const Rule& rule, const StampedTrack<Value>& track,
                               const typename StampedTrack<Value>::State& to, std::uint64_t lag,
                               const Value& value) {
  constexpr double pieces = 8.0;
  const double step = rule.distance(to.value, value) / pieces;
  double nearest = std::numeric_limits<double>::infinity();
  Value end = to.value;
  const auto before = track.up_to(to.stamp);
  for (auto state = before.rbegin();
       state != before.rend() && stamp_distance(state->stamp, to.stamp) <= lag; ++state) {
    const double length = rule.distance(state->value, end);
    const double parts = std::clamp(std::ceil(length / step), 1.0, pieces);
    for (double part = 0.0; part <= parts; ++part)
      nearest =
          std::min(nearest, rule.distance(value, rule.between(state->value, part / parts, end)));
    end = state->value;
  }
  return nearest;
}

/// Of two tracks that are apart at a stamp, by these values: the one is ahead that was where the
/// other one is within `lag` before it, if that one was not where this one is. Nothing: neither, or
/// both, as where they turn back.
template <typename Value, typename Rule>
[[nodiscard]] std::optional<std::size_t> who_is_ahead(
    const Rule& rule, const std::array<const StampedTrack<Value>*, 2>& tracks, std::int64_t stamp,
    const std::array<Value, 2>& values, std::uint64_t lag) {
  constexpr double there = 0.25, elsewhere = 0.75;  // of what is between them
  const double apart = rule.distance(values[0], values[1]);
  std::array<double, 2> missed{};
  for (std::size_t i = 0; i < 2; ++i)
    missed[i] = from_path(rule, *tracks[i], {stamp, values[i]}, lag, values[1 - i]);
  const std::size_t ahead = missed[0] < missed[1] ? 0 : 1;
  if (missed[ahead] > there * apart || missed[1 - ahead] < elsewhere * apart) return std::nullopt;
  return ahead;
}

}  // namespace penumbra
