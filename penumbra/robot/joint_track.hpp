// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace penumbra {

/// The values of one variable over time, sorted by stamp, one for each stamp.
class JointTrack {
 public:
  struct State {
    std::int64_t stamp;
    double value;
  };

  /// Adds a state at its place in time; replaces the one of the same stamp.
  void put(State state);

  void remove(std::int64_t stamp);

  /// Drops what lies before the last state at or before `limit`, then the oldest beyond
  /// `max_states`. Costs a fixed time per state dropped.
  void prune(std::int64_t limit, std::size_t max_states);

  void clear();

  [[nodiscard]] std::span<const State> states() const;
  [[nodiscard]] std::span<const State> up_to(std::int64_t stamp) const;    ///< at or before `stamp`
  [[nodiscard]] std::optional<double> value_at(std::int64_t stamp) const;  ///< exactly there

 private:
  std::vector<State> states_;
  std::size_t first_ = 0;  // states before it are dropped, and erased in bulk later
};

}  // namespace penumbra
