// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

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

// A float's digits, and an angle's between two equal rotations, radians or metres: values closer to
// each other are the same.
inline constexpr double same_value = 1e-6;

/// Whether a source told a value from one stamp to another.
template <typename Value, typename Rule>
[[nodiscard]] bool has_told(const Rule& rule, const StampedTrack<Value>& track, std::int64_t from,
                            std::int64_t to, const Value& value) {
  const auto told = track.up_to(to);
  for (auto state = told.rbegin(); state != told.rend() && state->stamp >= from; ++state)
    if (rule.distance(state->value, value) <= same_value) return true;
  return false;
}

/// A length that is known to within `error`.
struct Spacing {
  double length, error;
};

/// The greatest length that two are multiples of, by Euclid's algorithm, as far as they are known:
/// too great a one where that is too little.
[[nodiscard]] inline Spacing common_step(Spacing a, Spacing b) {
  if (a.length < b.length) std::swap(a, b);
  while (true) {
    const double times = std::round(a.length / b.length);
    const Spacing rest{std::abs(a.length - times * b.length), a.error + times * b.error};
    if (rest.length <= 2.0 * rest.error) return b;
    a = std::exchange(b, rest);
  }
}

/// The grid that states lie on: the greatest length that all steps from one to the next are
/// multiples of; 0 where they do not move. Of poses that turn far from their axis longer distances
/// are no multiples of a tick's.
template <typename Rule, typename States>
[[nodiscard]] double grid_of(const Rule& rule, const States& states) {
  constexpr double error = 2.0 * same_value;  // of a step
  Spacing grid{0.0, 0.0};
  for (std::size_t i = states.size(); i > 1; --i) {
    const Spacing step{rule.distance(states[i - 2].value, states[i - 1].value), error};
    if (step.length > error) grid = grid.length > 0.0 ? common_step(grid, step) : step;
  }
  return grid.length;
}

/// Whether it is no chance that a source told a value from one stamp to another: the values that it
/// told are much farther from this one than the grid is fine that they lie on. Of an encoder whose
/// every tick is told, who goes the same way tells the same numbers, too.
template <typename Value, typename Rule>
[[nodiscard]] bool is_telling(const Rule& rule, const StampedTrack<Value>& track, std::int64_t from,
                              std::int64_t to, const Value& value) {
  constexpr double farther = 16.0;  // one in so many values of such a grid is hit by chance
  auto told = track.up_to(to);
  const auto first = std::partition_point(told.begin(), told.end(),
                                          [&](const auto& state) { return state.stamp < from; });
  told = told.subspan(static_cast<std::size_t>(first - told.begin()));
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& state : told) {
    const double away = rule.distance(state.value, value);
    if (away > same_value) nearest = std::min(nearest, away);
  }
  const double grid = grid_of(rule, told);
  return grid > 0.0 && nearest < std::numeric_limits<double>::infinity() &&
         nearest >= farther * grid;
}

}  // namespace penumbra
