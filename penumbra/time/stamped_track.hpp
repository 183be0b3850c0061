// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <penumbra/base/stamps.hpp>

namespace penumbra {

/// A value over time: states sorted by stamp, one per stamp.
template <typename Value>
class StampedTrack {
 public:
  struct State {
    std::int64_t stamp;
    Value value;
  };

  /// Inserts a state in order; replaces one of the same stamp.
  void put(const State& state) {
    const auto at = place_of(state.stamp);
    if (at != states_.end() && at->stamp == state.stamp)
      *at = state;
    else
      states_.insert(at, state);
  }

  /// Drops all states before the last one at or before `limit`, then the oldest beyond
  /// `max_states`. Amortised constant time per dropped state.
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

  /// The two states around a stamp; equal if a state has the stamp.
  struct Bracket {
    const State* before = nullptr;
    const State* after = nullptr;

    explicit operator bool() const { return before != nullptr; }
    /// Nanoseconds.
    [[nodiscard]] std::uint64_t gap() const {
      return static_cast<std::uint64_t>(after->stamp) - static_cast<std::uint64_t>(before->stamp);
    }
  };

  /// Returns the states around `stamp`, or an empty bracket if one is missing or they are more than
  /// `max_gap` nanoseconds apart.
  [[nodiscard]] Bracket around(std::int64_t stamp, std::int64_t max_gap) const {
    const auto all = states();
    const auto before = up_to(stamp);
    if (before.empty()) return {};
    if (before.back().stamp == stamp) return {&before.back(), &before.back()};
    if (before.size() == all.size()) return {};
    const Bracket bracket{&before.back(), &all[before.size()]};
    return bracket.gap() <= static_cast<std::uint64_t>(max_gap) ? bracket : Bracket{};
  }

  /// Returns the states at or before `stamp`.
  [[nodiscard]] std::span<const State> up_to(std::int64_t stamp) const {
    const auto all = states();
    const auto end = std::upper_bound(
        all.begin(), all.end(), stamp,
        [](std::int64_t wanted, const State& state) { return wanted < state.stamp; });
    return all.first(static_cast<std::size_t>(end - all.begin()));
  }

  /// Returns the last state before `stamp`, or null.
  [[nodiscard]] const State* last_before(std::int64_t stamp) const {
    const auto before = up_to(stamp);
    if (!before.empty() && before.back().stamp < stamp) return &before.back();
    return before.size() < 2 ? nullptr : &before[before.size() - 2];
  }

  /// Returns the first state after `stamp`, or null.
  [[nodiscard]] const State* first_after(std::int64_t stamp) const {
    const auto all = states();
    const std::size_t next = up_to(stamp).size();
    return next < all.size() ? &all[next] : nullptr;
  }

  /// Returns the states from one stamp to another, both inclusive.
  [[nodiscard]] std::span<const State> between(std::int64_t from, std::int64_t to) const {
    const auto until = up_to(to);
    const auto first = std::lower_bound(
        until.begin(), until.end(), from,
        [](const State& state, std::int64_t wanted) { return state.stamp < wanted; });
    return until.subspan(static_cast<std::size_t>(first - until.begin()));
  }

  /// Returns the value of the state of exactly that stamp.
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
  std::size_t first_ = 0;  // states before it are dropped, and erased later in bulk
};

}  // namespace penumbra
