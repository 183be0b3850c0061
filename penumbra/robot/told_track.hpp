// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <penumbra/base/stamps.hpp>
#include <penumbra/robot/stamped_track.hpp>

namespace penumbra {

/// A value over time that several sources may tell, each by a number of its own. While one source
/// alone tells it, this is its StampedTrack. Where several do, each has a track, so that no value
/// is between those of two, and what they say of the same time is compared.
///
/// Two sources agree at a state of one if the other is at that value, too, within the rule's noise
/// and as far as the value travels, by either source, in `jitter` and the time between two states
/// of the one, or two such times of the other: a copy that is sent on lags by so much, and so may
/// an encoder that is read more seldom than it is told. What does not agree is a contradiction.
/// Nothing is compared where the two do not overlap, as of a source that ends and one that begins.
///
/// Of sources that agree one is taken: the one that moves, and that is ahead. What stands still or
/// lags may be a copy, or agree by chance. Until the next state of the one that is taken has come,
/// nothing is known. When it falls silent, another one takes over that begins after it, or moves on
/// its own: what stands still may be its copy. So it is where one of two who contradicted each
/// other falls silent. Who told nothing within the history is forgotten.
///
/// Two values of one source and stamp contradict each other, too, where the rule says so, if they
/// are farther apart than either is from the state before: stamps may be coarse.
///
/// Without comparing, the first source is taken, or one that begins after it has ended; others that
/// were there beside it are never taken.
///
/// Rule: double distance(Value, Value), Value between(Value, double share, Value), double noise(),
/// bool one_value_of_a_stamp.
template <typename Value, typename Rule>
class ToldTrack {
 public:
  using Track = StampedTrack<Value>;
  using State = typename Track::State;

  /// Nanoseconds that stamps of one instant may be apart: two threads' scheduling and a message's
  /// way between two programs.
  static constexpr std::int64_t jitter = 20'000'000;

  /// Nanoseconds that a contradiction lasts at least: longer than messages fail to come now and
  /// then, and short enough for results to be back a second after one of the two ended.
  static constexpr std::uint64_t memory = 800'000'000;

  /// Sources that are kept; of more the one that is silent for longest is forgotten.
  static constexpr std::size_t most_sources = 32;

  /// What two sources told of a stamp.
  struct Contradiction {
    std::array<std::uint32_t, 2> sources;
    std::array<Value, 2> values;
    /// Whether it is known of both how they came there. A copy may be heard before what it copies:
    /// the first states of a moving value may be apart though they are right.
    bool is_certain;
  };

  /// `max_gap`: nanoseconds between two states that may be interpolated. Without `compares` nothing
  /// is a contradiction.
  explicit ToldTrack(Rule rule, std::int64_t max_gap, bool compares = true)
      : rule_(std::move(rule)), max_gap_(max_gap), compares_(compares) {}

  /// Adds a state; replaces the one of the same stamp and source.
  void put(const State& state, std::uint32_t source) {
    if (all_.states().empty()) only_ = source;
    if (sources_.empty() && source != only_)
      sources_.push_back({only_, all_, all_.states().front().stamp, true});
    if (Rule::one_value_of_a_stamp && compares_) compare_with_itself(state, source);
    all_.put(state);
    if (sources_.empty()) return;
    const std::size_t teller = find_or_add(source, state.stamp);
    sources_[teller].track.put(state);
    sources_[teller].began = std::min(sources_[teller].began, state.stamp);
    if (compares_) compare(teller, state);
    if (takes_over(sources_[teller], state.stamp)) take(teller);
  }

  /// As of a StampedTrack; a source that told nothing since `limit` is forgotten.
  void prune(std::int64_t limit, std::size_t max_states) {
    all_.prune(limit, max_states);
    contradictions_.prune(limit, max_states);
    if (sources_.empty()) return;
    for (Source& source : sources_) source.track.prune(limit, max_states);
    for (std::size_t i = sources_.size(); i-- > 0;)
      if (sources_[i].track.states().empty() ||
          (end_of(sources_[i]) < limit && (compares_ || i != taken_)))
        forget(i);
    if (sources_.size() != 1) return;
    only_ = sources_.front().number;
    forget(0);
  }

  void clear() {
    all_.clear();
    sources_.clear();
    contradictions_.clear();
    taken_ = 0;
  }

  /// States of all sources.
  [[nodiscard]] const Track& all() const { return all_; }

  /// The track to interpolate at `stamp`: of the source that is taken there.
  [[nodiscard]] const Track& track_at(std::int64_t stamp) const {
    const Source* const source = source_at(stamp);
    return source == nullptr ? all_ : source->track;
  }

  /// Whose track that is; nothing where one source alone tells the value.
  [[nodiscard]] std::optional<std::uint32_t> teller_at(std::int64_t stamp) const {
    const Source* const source = source_at(stamp);
    return source == nullptr ? std::nullopt : std::optional(source->number);
  }

  /// A contradiction that holds at `stamp`: max_gap before or after it at most; of certain ones,
  /// `memory` before it, and for as long as one of the two is silent and the other has not moved.
  /// Null: there is none.
  [[nodiscard]] const typename StampedTrack<Contradiction>::State* contradiction_near(
      std::int64_t stamp) const {
    const auto all = contradictions_.states();
    if (all.empty()) return nullptr;
    const auto is_near = [&](const auto& found) {
      return stamp_distance(found.stamp, stamp) <= static_cast<std::uint64_t>(max_gap_);
    };
    const std::size_t split = contradictions_.up_to(stamp).size();
    for (std::size_t i = split; i > 0 && stamp_distance(all[i - 1].stamp, stamp) <= memory; --i)
      if (all[i - 1].value.is_certain || is_near(all[i - 1])) return &all[i - 1];
    if (split < all.size() && is_near(all[split])) return &all[split];
    return unsettled_before(stamp);
  }

 private:
  struct Source {
    std::uint32_t number;
    Track track;
    std::int64_t began;  // its first stamp
    bool was_taken = false;
    bool lags = false;  // it was last seen behind the one that was taken
  };

  /// The longest way between two states of a source that others are compared with.
  [[nodiscard]] std::int64_t longest() const {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    return max_gap_ > most / 2 ? most : 2 * max_gap_;
  }

  [[nodiscard]] static std::int64_t end_of(const Source& source) {
    return source.track.states().back().stamp;
  }

  std::size_t find_or_add(std::uint32_t number, std::int64_t stamp) {
    for (std::size_t i = 0; i < sources_.size(); ++i)
      if (sources_[i].number == number) return i;
    if (sources_.size() == most_sources) forget(silent_for_longest());
    sources_.push_back({number, {}, stamp});
    return sources_.size() - 1;
  }

  [[nodiscard]] std::size_t silent_for_longest() const {
    std::size_t found = taken_ == 0 ? 1 : 0;
    for (std::size_t i = 0; i < sources_.size(); ++i)
      if (i != taken_ && end_of(sources_[i]) < end_of(sources_[found])) found = i;
    return found;
  }

  void forget(std::size_t source) {
    sources_.erase(sources_.begin() + static_cast<std::ptrdiff_t>(source));
    if (taken_ > source)
      --taken_;
    else if (taken_ == source && !sources_.empty())
      take(0);
  }

  void take(std::size_t source) {
    taken_ = source;
    sources_[source].was_taken = true;
  }

  /// Whose word is taken at a stamp; null: one source alone tells the value.
  [[nodiscard]] const Source* source_at(std::int64_t stamp) const {
    if (sources_.empty()) return nullptr;
    const Source& taken = sources_[taken_];
    if (taken.track.around(stamp, max_gap_) || stamp > end_of(taken)) return &taken;
    // Before its first state those that were taken before it are; in a gap of it who agrees does.
    const bool is_before = stamp < taken.track.states().front().stamp;
    for (const Source& source : sources_)
      if ((is_before ? source.was_taken : compares_ && !source.lags) &&
          source.track.around(stamp, max_gap_))
        return &source;
    return &taken;
  }

  /// Whether a source that tells a state takes over from the one that is taken: as that one is
  /// silent, or tells too seldom to be interpolated.
  [[nodiscard]] bool takes_over(const Source& source, std::int64_t stamp) const {
    const Source& taken = sources_[taken_];
    if (&source == &taken) return false;
    const std::int64_t end = end_of(taken);
    if (stamp > end && stamp_distance(stamp, end) > static_cast<std::uint64_t>(max_gap_) &&
        succeeds(source, end, stamp))
      return true;
    return compares_ && is_seldom(taken) && !source.lags && source.track.states().size() > 2 &&
           !is_seldom(source);
  }

  /// Whether the last two times between states are both too long.
  [[nodiscard]] bool is_seldom(const Source& source) const {
    const auto all = source.track.states();
    if (all.size() < 3) return false;
    const auto is_long = [&](std::size_t i) {
      return stamp_distance(all[i].stamp, all[i - 1].stamp) > static_cast<std::uint64_t>(max_gap_);
    };
    return is_long(all.size() - 1) && is_long(all.size() - 2);
  }

  /// Whether a source is no copy of one that ended, at `stamp`: it began later, or moved since. A
  /// copy may move on for as long as it lags.
  [[nodiscard]] bool succeeds(const Source& source, std::int64_t end, std::int64_t stamp) const {
    const auto all = source.track.states();
    if (source.began > end) return true;
    if (!compares_) return false;
    const auto caught_up = source.track.up_to(stamp_after(end, longest()));
    const Value& from = caught_up.empty() ? all.front().value : caught_up.back().value;
    for (std::size_t i = caught_up.size(); i < all.size() && all[i].stamp <= stamp; ++i)
      if (rule_.distance(from, all[i].value) > rule_.noise()) return true;
    return false;
  }

  /// The last certain contradiction of two sources that is not settled at `stamp`.
  [[nodiscard]] const typename StampedTrack<Contradiction>::State* unsettled_before(
      std::int64_t stamp) const {
    if (sources_.empty()) return nullptr;
    const auto before = contradictions_.up_to(stamp);
    std::array<std::array<std::uint32_t, 2>, 8> looked_at{};
    std::size_t pairs = 0;
    for (auto found = before.rbegin(); found != before.rend(); ++found) {
      const auto end = looked_at.begin() + static_cast<std::ptrdiff_t>(pairs);
      if (!found->value.is_certain ||
          std::find(looked_at.begin(), end, found->value.sources) != end)
        continue;
      if (pairs == looked_at.size() || !is_settled(found->value.sources, stamp)) return &*found;
      looked_at[pairs++] = found->value.sources;
    }
    return nullptr;
  }

  /// Of two sources that contradicted each other more than `memory` ago: whether both were heard
  /// since, so that they agree, or one of them has proven itself since the other one fell silent.
  [[nodiscard]] bool is_settled(const std::array<std::uint32_t, 2>& pair,
                                std::int64_t stamp) const {
    if (pair[0] == pair[1]) return true;
    std::array<const Source*, 2> both{};
    for (const Source& source : sources_)
      for (std::size_t i = 0; i < 2; ++i)
        if (source.number == pair[i]) both[i] = &source;
    if (both[0] == nullptr || both[1] == nullptr) return true;  // forgotten
    const std::array ends = {heard_until(*both[0], stamp), heard_until(*both[1], stamp)};
    const std::size_t silent = ends[0] < ends[1] ? 0 : 1;
    const auto is_silent = [&](std::int64_t end) {
      return stamp_distance(end, stamp) > static_cast<std::uint64_t>(longest());
    };
    if (!is_silent(ends[silent]) || is_silent(ends[1 - silent])) return true;
    return succeeds(*both[1 - silent], ends[silent], stamp);
  }

  /// The last state of a source at or before a stamp.
  [[nodiscard]] static std::int64_t heard_until(const Source& source, std::int64_t stamp) {
    const auto before = source.track.up_to(stamp);
    return before.empty() ? std::numeric_limits<std::int64_t>::min() / 2 : before.back().stamp;
  }

  /// Compares a new state with what its source told of the very stamp.
  void compare_with_itself(const State& state, std::uint32_t source) {
    const Track& own = sources_.empty() ? all_ : sources_[find_or_add(source, state.stamp)].track;
    const auto told = own.value_at(state.stamp);
    if (!told) return;
    double allowed = rule_.noise();
    if (const State* const last = own.last_before(state.stamp))
      allowed +=
          std::min(rule_.distance(last->value, *told), rule_.distance(last->value, state.value));
    if (rule_.distance(*told, state.value) > allowed)
      note({state.stamp, {{source, source}, {*told, state.value}, true}});
  }

  /// Compares a new state with the others, and their states beside it with its source, which is
  /// known on to it now.
  void compare(std::size_t teller, const State& state) {
    const Track& own = sources_[teller].track;
    const State* const last = own.last_before(state.stamp);
    const auto until = own.up_to(state.stamp);
    const bool is_newest = until.size() == own.states().size();
    const std::int64_t next = is_newest ? state.stamp : own.states()[until.size()].stamp;
    for (std::size_t other = 0; other < sources_.size(); ++other) {
      if (other == teller) continue;
      judge(state, teller, other);
      const std::int64_t first = last == nullptr ? state.stamp : last->stamp;
      const auto all = sources_[other].track.states();
      for (std::size_t i = sources_[other].track.up_to(first).size();
           i < all.size() && all[i].stamp < next; ++i)
        if (all[i].stamp != state.stamp) judge(all[i], other, teller);
    }
  }

  /// Compares a state with what another source says of its stamp, if it does.
  void judge(const State& state, std::size_t teller, std::size_t other) {
    const Track& own_track = sources_[teller].track;
    const Track& theirs = sources_[other].track;
    const auto around = theirs.around(state.stamp, longest());
    if (!around) return;
    const State* const last = own_track.last_before(state.stamp);
    const std::uint64_t lag =
        static_cast<std::uint64_t>(jitter) +
        std::max(2 * gap_before(theirs, around), last == nullptr ? 0 : gap(*last, state));
    const Value told = value_at(around, state.stamp);
    const double apart = rule_.distance(state.value, told);
    if (apart <= rule_.noise()) return;
    const double own = travel(own_track, state.stamp, lag, state.value);
    const double other_ones = travel(theirs, state.stamp, lag, told);
    if (apart > rule_.noise() + own + other_ones) {
      note({state.stamp,
            {{sources_[teller].number, sources_[other].number},
             {state.value, told},
             last != nullptr && is_known_for(own_track, state.stamp, lag) &&
                 is_known_for(theirs, state.stamp, lag)}});
    } else if (taken_ == teller || taken_ == other) {
      const bool is_still = std::min(own, other_ones) <= rule_.noise();
      const double ahead = is_still ? own - other_ones : lead(state, told, {teller, other}, lag);
      if (std::abs(ahead) <= rule_.noise()) return;
      take(ahead > 0.0 ? teller : other);
      sources_[taken_].lags = false;
      sources_[taken_ == teller ? other : teller].lags = !is_still;
    }
  }

  /// Sources in the order in which they were first heard.
  void note(typename StampedTrack<Contradiction>::State found) {
    if (found.value.sources[0] > found.value.sources[1]) {
      std::swap(found.value.sources[0], found.value.sources[1]);
      std::swap(found.value.values[0], found.value.values[1]);
    }
    const auto known = contradictions_.value_at(found.stamp);
    if (!known || !known->is_certain || found.value.is_certain) contradictions_.put(found);
  }

  [[nodiscard]] static bool is_known_for(const Track& track, std::int64_t stamp,
                                         std::uint64_t lag) {
    const std::int64_t first = track.states().front().stamp;
    return first <= stamp && stamp_distance(first, stamp) >= lag;
  }

  /// Of two sources that agree, but are apart, the one is ahead that has come farther on the way of
  /// both; the other sends on what it said. Above 0: the first one, which tells `state`.
  [[nodiscard]] double lead(const State& state, const Value& told,
                            const std::array<std::size_t, 2>& of, std::uint64_t lag) const {
    double ahead = 0.0;
    for (const std::size_t source : of) {
      const auto states = sources_[source].track.within(state.stamp, lag);
      if (states.empty()) continue;
      const Value& from = states.front().value;
      ahead += rule_.distance(state.value, from) - rule_.distance(told, from);
    }
    return ahead;
  }

  [[nodiscard]] Value value_at(const typename Track::Bracket& around, std::int64_t stamp) const {
    if (around.before == around.after) return around.before->value;
    const double share = static_cast<double>(stamp_distance(around.before->stamp, stamp)) /
                         static_cast<double>(around.gap());
    return rule_.between(around.before->value, share, around.after->value);
  }

  /// The time between states there, 0 if it is not known.
  [[nodiscard]] std::uint64_t gap_before(const Track& track,
                                         const typename Track::Bracket& around) const {
    if (around.before != around.after) return around.gap();
    const State* const last = track.last_before(around.before->stamp);
    return last == nullptr ? 0 : gap(*last, *around.before);
  }

  /// Between two states of a source.
  [[nodiscard]] std::uint64_t gap(const State& a, const State& b) const {
    return std::min(stamp_distance(a.stamp, b.stamp), static_cast<std::uint64_t>(longest()));
  }

  /// How far a source gets from a value there.
  [[nodiscard]] double travel(const Track& track, std::int64_t stamp, std::uint64_t lag,
                              const Value& from) const {
    double most = 0.0;
    for (const State& state : track.within(stamp, lag))
      most = std::max(most, rule_.distance(state.value, from));
    return most;
  }

  Rule rule_;
  std::int64_t max_gap_;
  bool compares_;
  std::uint32_t only_ = 0;  // who tells all, where sources_ is empty
  std::size_t taken_ = 0;
  Track all_;
  std::vector<Source> sources_;  // empty, or two at least
  StampedTrack<Contradiction> contradictions_;
};

}  // namespace penumbra
