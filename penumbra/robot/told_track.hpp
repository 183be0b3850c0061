// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

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
/// Of sources that agree the one that moves is taken, and the one that is ahead: what stands still
/// or lags may be a copy, or agree by chance.
///
/// Two values of one source and stamp contradict each other, too, where the rule says so, if they
/// are farther apart than either is from the state before: stamps may be coarse.
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

  /// Nanoseconds until one who contradicted another is believed alone: longer than messages fail to
  /// come now and then, and short enough for results to be back a second after one of the two
  /// ended.
  static constexpr std::uint64_t memory = 800'000'000;

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
    if (sources_.empty() && source != only_) sources_.push_back({only_, all_});
    if (Rule::one_value_of_a_stamp && compares_) compare_with_itself(state, source);
    all_.put(state);
    if (sources_.empty()) return;
    const std::size_t teller = find_or_add(source);
    sources_[teller].track.put(state);
    if (compares_) compare(teller, state);
  }

  void remove(std::int64_t stamp) {
    all_.remove(stamp);
    for (Source& source : sources_) source.track.remove(stamp);
    contradictions_.remove(stamp);
  }

  /// As of a StampedTrack; a source that told nothing since `limit` is forgotten.
  void prune(std::int64_t limit, std::size_t max_states) {
    all_.prune(limit, max_states);
    contradictions_.prune(limit, max_states);
    if (sources_.empty()) return;
    for (Source& source : sources_) source.track.prune(limit, max_states);
    for (std::size_t i = sources_.size(); i-- > 0;)
      if (sources_[i].track.states().empty() || sources_[i].track.states().back().stamp < limit)
        forget(i);
    if (sources_.size() != 1) return;
    only_ = sources_.front().number;
    forget(0);
  }

  void clear() {
    all_.clear();
    sources_.clear();
    contradictions_.clear();
    preferred_ = 0;
  }

  /// States of all sources.
  [[nodiscard]] const Track& all() const { return all_; }

  /// The track to interpolate at `stamp`: of the source that is ahead of the others, as far as it
  /// is known there, else of another one, else of all.
  [[nodiscard]] const Track& track_at(std::int64_t stamp) const {
    if (sources_.empty() || sources_[preferred_].track.around(stamp, max_gap_))
      return sources_.empty() ? all_ : sources_[preferred_].track;
    for (const Source& source : sources_)
      if (source.track.around(stamp, max_gap_)) return source.track;
    return all_;
  }

  /// A contradiction near `stamp`: max_gap before or after it at most, or `memory` before it if it
  /// is certain; null: there is none.
  [[nodiscard]] const typename StampedTrack<Contradiction>::State* contradiction_near(
      std::int64_t stamp) const {
    const auto all = contradictions_.states();
    if (all.empty()) return nullptr;
    const auto is_near = [&](const auto& found) {
      return distance_of(found.stamp, stamp) <= static_cast<std::uint64_t>(max_gap_);
    };
    const std::size_t split = contradictions_.up_to(stamp).size();
    for (std::size_t i = split; i > 0 && distance_of(all[i - 1].stamp, stamp) <= memory; --i)
      if (all[i - 1].value.is_certain || is_near(all[i - 1])) return &all[i - 1];
    return split < all.size() && is_near(all[split]) ? &all[split] : nullptr;
  }

 private:
  struct Source {
    std::uint32_t number;
    Track track;
  };

  static std::uint64_t distance_of(std::int64_t a, std::int64_t b) {
    const auto x = static_cast<std::uint64_t>(std::max(a, b));
    return x - static_cast<std::uint64_t>(std::min(a, b));
  }
  /// The longest way between two states of a source that others are compared with.
  [[nodiscard]] std::int64_t longest() const {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    return max_gap_ > most / 2 ? most : 2 * max_gap_;
  }

  std::size_t find_or_add(std::uint32_t number) {
    for (std::size_t i = 0; i < sources_.size(); ++i)
      if (sources_[i].number == number) return i;
    sources_.push_back({number, {}});
    return sources_.size() - 1;
  }

  void forget(std::size_t source) {
    sources_.erase(sources_.begin() + static_cast<std::ptrdiff_t>(source));
    if (preferred_ == source) preferred_ = 0;
    if (preferred_ > source) --preferred_;
  }

  [[nodiscard]] static const State* before(const Track& track, std::int64_t stamp) {
    const auto up_to = track.up_to(stamp);
    if (!up_to.empty() && up_to.back().stamp < stamp) return &up_to.back();
    return up_to.size() < 2 ? nullptr : &up_to[up_to.size() - 2];
  }

  /// Compares a new state with what its source told of the very stamp.
  void compare_with_itself(const State& state, std::uint32_t source) {
    const Track& own = sources_.empty() ? all_ : sources_[find_or_add(source)].track;
    const auto told = own.value_at(state.stamp);
    if (!told) return;
    double allowed = rule_.noise();
    if (const State* const last = before(own, state.stamp))
      allowed +=
          std::min(rule_.distance(last->value, *told), rule_.distance(last->value, state.value));
    if (rule_.distance(*told, state.value) > allowed)
      note({state.stamp, {{source, source}, {*told, state.value}, true}});
  }

  /// Compares a new state with the others, and their states beside it with its source, which is
  /// known on to it now.
  void compare(std::size_t teller, const State& state) {
    const Track& own = sources_[teller].track;
    const State* const last = before(own, state.stamp);
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
    const State* const last = before(own_track, state.stamp);
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
    } else if (preferred_ == teller || preferred_ == other) {
      const bool is_still = std::min(own, other_ones) <= rule_.noise();
      const double ahead = is_still ? own - other_ones : lead(state, told, {teller, other}, lag);
      if (std::abs(ahead) > rule_.noise()) preferred_ = ahead > 0.0 ? teller : other;
    }
  }

  /// Sources in the order in which they were first heard.
  void note(typename StampedTrack<Contradiction>::State found) {
    if (found.value.sources[0] > found.value.sources[1]) {
      std::swap(found.value.sources[0], found.value.sources[1]);
      std::swap(found.value.values[0], found.value.values[1]);
    }
    contradictions_.put(found);
  }

  [[nodiscard]] static bool is_known_for(const Track& track, std::int64_t stamp,
                                         std::uint64_t lag) {
    const std::int64_t first = track.states().front().stamp;
    return first <= stamp && distance_of(first, stamp) >= lag;
  }

  /// Of two sources that agree, but are apart, the one is ahead that has come farther on the way of
  /// both; the other sends on what it said. Above 0: the first one, which tells `state`.
  [[nodiscard]] double lead(const State& state, const Value& told,
                            const std::array<std::size_t, 2>& of, std::uint64_t lag) const {
    double ahead = 0.0;
    for (const std::size_t source : of) {
      const auto [first, last] = within(sources_[source].track, state.stamp, lag);
      if (first != last)
        ahead += rule_.distance(state.value, first->value) - rule_.distance(told, first->value);
    }
    return ahead;
  }

  [[nodiscard]] Value value_at(const typename Track::Bracket& around, std::int64_t stamp) const {
    if (around.before == around.after) return around.before->value;
    const double share = static_cast<double>(distance_of(around.before->stamp, stamp)) /
                         static_cast<double>(around.gap());
    return rule_.between(around.before->value, share, around.after->value);
  }

  /// The time between states there, 0 if it is not known.
  [[nodiscard]] std::uint64_t gap_before(const Track& track,
                                         const typename Track::Bracket& around) const {
    if (around.before != around.after) return around.gap();
    const State* const last = before(track, around.before->stamp);
    return last == nullptr ? 0 : gap(*last, *around.before);
  }

  /// Between two states of a source.
  [[nodiscard]] std::uint64_t gap(const State& a, const State& b) const {
    return std::min(distance_of(a.stamp, b.stamp), static_cast<std::uint64_t>(longest()));
  }

  /// States from `lag` before `stamp` to `lag` after it.
  [[nodiscard]] static std::pair<const State*, const State*> within(const Track& track,
                                                                    std::int64_t stamp,
                                                                    std::uint64_t lag) {
    const auto all = track.states();
    const State* first = all.data() + track.up_to(stamp).size();
    const State* last = first;
    while (first != all.data() && distance_of((first - 1)->stamp, stamp) <= lag) --first;
    while (last != all.data() + all.size() && distance_of(last->stamp, stamp) <= lag) ++last;
    return {first, last};
  }

  /// How far a source gets from a value there.
  [[nodiscard]] double travel(const Track& track, std::int64_t stamp, std::uint64_t lag,
                              const Value& from) const {
    double most = 0.0;
    const auto [first, last] = within(track, stamp, lag);
    for (const State* state = first; state != last; ++state)
      most = std::max(most, rule_.distance(state->value, from));
    return most;
  }

  Rule rule_;
  std::int64_t max_gap_;
  bool compares_;
  std::uint32_t only_ = 0;  // who tells all, where sources_ is empty
  std::size_t preferred_ = 0;
  Track all_;
  std::vector<Source> sources_;  // empty, or two at least
  StampedTrack<Contradiction> contradictions_;
};

}  // namespace penumbra
