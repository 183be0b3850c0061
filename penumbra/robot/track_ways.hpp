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

/// The greatest step of which both are multiples, by Euclid's algorithm; as good as none if they
/// are of no grid.
[[nodiscard]] inline double common_step(double a, double b) {
  while (b > 3.0 * same_value) {
    const double rest = std::fmod(a, b);
    a = std::exchange(b, std::min(rest, b - rest));
  }
  return a;
}

/// Whether it is no chance that a source told a value from one stamp to another: the values that it
/// told are much farther from this one than the grid is fine that they lie on. Of an encoder whose
/// every tick is told, who goes the same way tells the same numbers, too.
template <typename Value, typename Rule>
[[nodiscard]] bool is_telling(const Rule& rule, const StampedTrack<Value>& track, std::int64_t from,
                              std::int64_t to, const Value& value) {
  constexpr double farther = 16.0;  // one in so many values of such a grid is hit by chance
  double grid = 0.0, nearest = std::numeric_limits<double>::infinity();
  const auto told = track.up_to(to);
  for (std::size_t i = told.size(); i > 0 && told[i - 1].stamp >= from; --i) {
    const double away = rule.distance(told[i - 1].value, value);
    if (away > same_value) nearest = std::min(nearest, away);
    const double step = i < 2 ? 0.0 : rule.distance(told[i - 2].value, told[i - 1].value);
    if (step > same_value) grid = common_step(std::max(grid, step), std::min(grid, step));
  }
  return grid > 0.0 && nearest >= farther * grid;
}

}  // namespace penumbra
