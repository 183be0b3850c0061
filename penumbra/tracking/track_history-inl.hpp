// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::detail {

/// Returns the seconds from one stamp to a later or equal one; exact for any two stamps.
[[nodiscard]] inline double seconds_between(std::int64_t from, std::int64_t to) {
  return static_cast<double>(static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from)) /
         1e9;
}

/// Returns whether estimates with this verdict are accepted. Others than visible, partial and
/// hidden never are.
[[nodiscard]] inline bool good_enough(Verdict verdict, Verdict worst) {
  return verdict <= Verdict::hidden && verdict <= worst;
}

/// The estimates of the last seconds sorted by stamp, with the belief after each.
///
/// Beliefs depend only on the sorted estimates: a late estimate is inserted and all later ones are
/// filtered and gated again. The order of arrival does not matter.
///
/// Filter: State begin(Measurement); State predicted(State, double seconds), additive in seconds;
/// double distance(State, Measurement), squared Mahalanobis; void correct(State&, Measurement).
/// State and Measurement can be copied without allocation. Config: with track_settings(). Memory
/// grows to max_estimates.
template <class Filter, class Config>
class TrackHistory {
 public:
  using State = typename Filter::State;
  using Measurement = typename Filter::Measurement;

  /// The belief at a stamp.
  struct Recall {
    State state;            ///< filtered and predicted to the stamp
    double age = 0;         ///< seconds since the last accepted estimate
    bool measured = false;  ///< that estimate has exactly this stamp
    bool lost = false;      ///< that estimate is older than the time-out
  };

  TrackHistory(const Filter& filter, const Config& rules) : filter_(filter), rules_(rules) {}

  Outcome take(std::int64_t stamp, const Measurement& measurement) {
    if (too_late(stamp)) return Outcome::refused_late;
    const std::size_t place = place_of(stamp);
    if (place > 0 && entry(place - 1).stamp == stamp) return Outcome::refused_invalid;
    if (!has_room(place)) return Outcome::refused_late;
    const std::size_t forgotten = forget(stamp);
    insert(place - forgotten, stamp, measurement);
    return replay(place - forgotten);
  }

  /// Returns null before the first remembered estimate.
  [[nodiscard]] std::optional<Recall> at(std::int64_t stamp) const {
    const std::size_t place = place_of(stamp);
    if (place == 0) return std::nullopt;
    const Entry& last = entry(place - 1);
    const double age = seconds_between(last.belief.accepted, stamp);
    return Recall{filter_.predicted(last.belief.state, seconds_between(last.stamp, stamp)), age,
                  last.belief.accepted == stamp, age > rules_.timeout};
  }

  void reset() {
    used_ = 0;
    forgot_ = false;
  }

 private:
  /// The belief after an estimate, at its stamp.
  struct Belief {
    State state;
    std::int64_t accepted = 0;  ///< stamp of the last accepted estimate
    std::size_t outliers = 0;   ///< consecutive and consistent with each other
    State candidate;            ///< the track that follows the outliers
  };

  struct Entry {
    std::int64_t stamp = 0;
    Measurement measurement;
    Belief belief;
  };

  [[nodiscard]] const Entry& entry(std::size_t i) const { return entries_[order_[i]]; }

  [[nodiscard]] bool too_late(std::int64_t stamp) const {
    if (used_ == 0) return false;
    const std::int64_t newest = entry(used_ - 1).stamp;
    return stamp < newest && seconds_between(stamp, newest) > rules_.memory;
  }

  /// Returns the number of entries with this stamp or an earlier one.
  [[nodiscard]] std::size_t place_of(std::int64_t stamp) const {
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(used_);
    const auto later = [this](std::int64_t s, std::size_t slot) {
      return s < entries_[slot].stamp;
    };
    return static_cast<std::size_t>(std::upper_bound(order_.begin(), end, stamp, later) -
                                    order_.begin());
  }

  /// An estimate needs an entry before it to start from, unless the very first is remembered.
  [[nodiscard]] bool has_room(std::size_t place) const {
    const bool full = used_ == rules_.max_estimates;
    return place > (full ? 1U : 0U) || (!forgot_ && !full);
  }

  /// Drops entries beyond the memory except the last of them, which later ones start from. Returns
  /// the number of dropped entries.
  std::size_t forget(std::int64_t stamp) {
    const std::int64_t newest = used_ == 0 ? stamp : std::max(stamp, entry(used_ - 1).stamp);
    std::size_t count = used_ == rules_.max_estimates ? 1 : 0;
    while (count + 1 < used_ && seconds_between(entry(count + 1).stamp, newest) > rules_.memory) {
      ++count;
    }
    const auto shift = static_cast<std::ptrdiff_t>(count);
    std::rotate(order_.begin(), order_.begin() + shift,
                order_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ -= count;
    forgot_ = forgot_ || count > 0;
    return count;
  }

  /// `order_` beyond `used_` lists free entries.
  void insert(std::size_t place, std::int64_t stamp, const Measurement& measurement) {
    if (used_ == order_.size()) {
      order_.push_back(entries_.size());
      entries_.emplace_back();
    }
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(place);
    const auto free = order_.begin() + static_cast<std::ptrdiff_t>(used_);
    std::rotate(begin, free, free + 1);
    ++used_;
    entries_[order_[place]].stamp = stamp;
    entries_[order_[place]].measurement = measurement;
  }

  Outcome replay(std::size_t first) {
    const Outcome outcome = step(first);
    for (std::size_t i = first + 1; i < used_; ++i) step(i);
    return outcome;
  }

  Outcome step(std::size_t i) {
    Entry& now = entries_[order_[i]];
    if (i == 0) {
      now.belief = {filter_.begin(now.measurement), now.stamp, 0, {}};
      return Outcome::accepted;
    }
    const Entry& before = entry(i - 1);
    const double dt = seconds_between(before.stamp, now.stamp);
    now.belief.state = filter_.predicted(before.belief.state, dt);
    now.belief.accepted = before.belief.accepted;
    if (!inside_gate(now.belief.state, now.measurement))
      return take_outlier(before.belief, dt, now);
    accept(now);
    return Outcome::accepted;
  }

  /// Restarts a lost track, whose velocity is outdated.
  void accept(Entry& now) {
    Belief& belief = now.belief;
    if (seconds_between(belief.accepted, now.stamp) > rules_.timeout) {
      belief.state = filter_.begin(now.measurement);
    } else {
      filter_.correct(belief.state, now.measurement);
    }
    belief.accepted = now.stamp;
    belief.outliers = 0;
  }

  /// Counts an outlier; enough consistent ones make a new track.
  Outcome take_outlier(const Belief& before, double dt, Entry& now) {
    Belief& belief = now.belief;
    const bool in_row = before.outliers > 0 && dt <= rules_.timeout;
    if (in_row) belief.candidate = filter_.predicted(before.candidate, dt);
    if (in_row && inside_gate(belief.candidate, now.measurement)) {
      filter_.correct(belief.candidate, now.measurement);
      belief.outliers = before.outliers + 1;
    } else {
      belief.candidate = filter_.begin(now.measurement);
      belief.outliers = 1;
    }
    if (belief.outliers < rules_.gate_patience) return Outcome::refused_gate;
    belief.state = belief.candidate;
    belief.accepted = now.stamp;
    belief.outliers = 0;
    return Outcome::accepted;
  }

  /// Returns false for a distance of NaN.
  [[nodiscard]] bool inside_gate(const State& state, const Measurement& measurement) const {
    return filter_.distance(state, measurement) <= rules_.gate;
  }

  Filter filter_;
  Config rules_;
  std::vector<Entry> entries_;
  std::vector<std::size_t> order_;  ///< of the entries by stamp
  std::size_t used_ = 0;            ///< entries in use
  bool forgot_ = false;             ///< the very first estimate was dropped
};

/// `held`: the target is assumed not to move.
template <class Recall>
[[nodiscard]] Source source_of(const Recall& recall, bool held) {
  if (recall.lost) return Source::lost;
  if (recall.measured) return Source::measured;
  return held ? Source::held : Source::predicted;
}

}  // namespace penumbra::detail
