// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra {

/// A value over time: states sorted by stamp, one for each stamp.
template <typename Value>
class StampedTrack {
 public:
  struct State {
    std::int64_t stamp;
    Value value;
  };

  /// Adds a state at its place in time; replaces the one of the same stamp.
  void put(const State& state) {
    const auto at = place_of(state.stamp);
    if (at != states_.end() && at->stamp == state.stamp)
      *at = state;
    else
      states_.insert(at, state);
  }

  void remove(std::int64_t stamp) {
    const auto at = place_of(stamp);
    if (at != states_.end() && at->stamp == stamp) states_.erase(at);
  }

  /// Drops what lies before the last state at or before `limit`, then the oldest beyond
  /// `max_states`. Costs a fixed time per state dropped.
  void prune(std::int64_t limit, std::size_t max_states) {
    while (first_ + 1 < states_.size() && states_[first_ + 1].stamp <= limit) ++first_;
    if (states_.size() - first_ > max_states) first_ = states_.size() - max_states;
    if (first_ > states_.size() / 2) {
      states_.erase(states_.begin(), begin());
      first_ = 0;
    }
  }

  void clear() {
    states_.clear();
    first_ = 0;
  }

  [[nodiscard]] std::span<const State> states() const { return std::span(states_).subspan(first_); }

  /// States at or before `stamp`.
  [[nodiscard]] std::span<const State> up_to(std::int64_t stamp) const {
    const auto all = states();
    const auto end = std::upper_bound(
        all.begin(), all.end(), stamp,
        [](std::int64_t wanted, const State& state) { return wanted < state.stamp; });
    return all.first(static_cast<std::size_t>(end - all.begin()));
  }

  /// The value of a state exactly there.
  [[nodiscard]] std::optional<Value> value_at(std::int64_t stamp) const {
    const auto before = up_to(stamp);
    if (before.empty() || before.back().stamp != stamp) return std::nullopt;
    return before.back().value;
  }

 private:
  using Place = typename std::vector<State>::iterator;

  Place begin() { return states_.begin() + static_cast<std::ptrdiff_t>(first_); }
  Place place_of(std::int64_t stamp) {
    return std::lower_bound(
        begin(), states_.end(), stamp,
        [](const State& state, std::int64_t wanted) { return state.stamp < wanted; });
  }

  std::vector<State> states_;
  std::size_t first_ = 0;  // states before it are dropped, and erased in bulk later
};

}  // namespace penumbra
