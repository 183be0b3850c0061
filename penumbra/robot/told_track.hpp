// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <penumbra/base/stamps.hpp>
#include <penumbra/robot/stamped_track.hpp>
#include <penumbra/robot/told_source.hpp>
#include <penumbra/robot/track_ways.hpp>

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
/// A value is known where all sources tell it, but for copies: within the rule's noise of each
/// other. The one whose states are closest there gives it. A source that falls silent is waited for
/// until one succeeds it that begins after it, or moves on its own: what stands still may be its
/// copy. Who told nothing within the history is forgotten.
///
/// A copy is a source whose new values are those that another one told before: heard before, and
/// of an earlier stamp or the same. A program that is ahead of the driver, as with commands, or
/// that only looks ahead, as by a clock that is behind, is none, and makes nobody one. A copy is
/// compared with nobody, and tells nothing, until it tells values of its own beside those that are
/// heard.
///
/// Two values of one source and stamp contradict each other, too, where the rule says so, if they
/// are farther apart than either is from the state before: stamps may be coarse.
///
/// Without comparing, the first source is taken, or while that is silent one that began since;
/// others that were there beside it are never taken.
///
/// Rule: double distance(Value, Value), Value between(Value, double share, Value), double noise(),
/// bool one_value_of_a_stamp.
template <typename Value, typename Rule>
class ToldTrack {
 public:
  using Track = StampedTrack<Value>;
  using State = typename Track::State;
  using Bracket = typename Track::Bracket;

  /// Nanoseconds that stamps of one instant may be apart: two threads' scheduling and a message's
  /// way between two programs.
  static constexpr std::int64_t jitter = 20'000'000;

  /// Nanoseconds that a contradiction lasts at least: longer than messages fail to come now and
  /// then, and short enough for results to be back a second after one of the two ended.
  static constexpr std::uint64_t memory = 800'000'000;

  /// Nanoseconds that a copy may be late by; what is later is another program's word.
  static constexpr std::int64_t longest_lag = 2'000'000'000;

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
    if (sources_.empty() && source != only_) {
      const auto told = all_.states();
      const std::size_t n = told.size();
      sources_.push_back({only_, all_, told.front().stamp,
                          n < 2 ? 0 : stamp_distance(told[n - 2].stamp, told[n - 1].stamp)});
    }
    if (Rule::one_value_of_a_stamp && compares_) compare_with_itself(state, source);
    all_.put(state);
    if (sources_.empty()) return;
    const std::size_t teller = find_or_add(source, state.stamp);
    Source& own = sources_[teller];
    if (compares_) weigh(own, state);
    if (!own.track.states().empty() && state.stamp > own.end()) {
      own.period = stamp_distance(own.end(), state.stamp);
      own.succeeded = own.missed_since = never;
    }
    own.track.put(state);
    own.began = std::min(own.began, state.stamp);
    if (!compares_) return;
    for (Source& each : sources_) settle(each);
    compare(teller, state);
    succeed(own, state);
  }

  /// As of a StampedTrack; a source that told nothing since `limit` is forgotten.
  void prune(std::int64_t limit, std::size_t max_states) {
    all_.prune(limit, max_states);
    contradictions_.prune(limit, max_states);
    if (sources_.empty()) return;
    for (Source& source : sources_) source.track.prune(limit, max_states);
    if (!compares_) return;  // who was there beside the first one is known for ever
    const std::int64_t heard_since =
        std::min(limit, stamp_after(all_.states().back().stamp, -Source::shortest_history));
    std::erase_if(sources_, [&](const Source& source) { return source.end() < heard_since; });
    if (sources_.size() > 1 || (sources_.size() == 1 && sources_.front().is_copy())) return;
    if (sources_.size() == 1) {
      only_ = sources_.front().number;
      all_ = sources_.front().track;
    }
    sources_.clear();
  }

  void clear() {
    all_.clear();
    sources_.clear();
    contradictions_.clear();
  }

  /// States of all sources.
  [[nodiscard]] const Track& all() const { return all_; }

  /// The states to interpolate between at `stamp`; none where nothing is known.
  [[nodiscard]] Bracket around(std::int64_t stamp) const {
    return sources_.empty() ? all_.around(stamp, max_gap_) : word_at(stamp).around;
  }

  /// The track of the source that tells `stamp`, or of the one that is waited for.
  [[nodiscard]] const Track& track_at(std::int64_t stamp) const {
    const Source* const source = word_at(stamp).source;
    return source == nullptr ? all_ : source->track;
  }

  /// Whose track that is; nothing where one source alone tells the value.
  [[nodiscard]] std::optional<std::uint32_t> teller_at(std::int64_t stamp) const {
    const Source* const source = word_at(stamp).source;
    return source == nullptr ? std::nullopt : std::optional(source->number);
  }

  /// A contradiction that holds at `stamp`: max_gap before or after it at most; of certain ones,
  /// `memory` before it. Null: there is none.
  [[nodiscard]] const typename StampedTrack<Contradiction>::State* contradiction_near(
      std::int64_t stamp) const {
    const auto all = contradictions_.states();
    const auto is_near = [&](const auto& found) {
      return stamp_distance(found.stamp, stamp) <= static_cast<std::uint64_t>(max_gap_);
    };
    const std::size_t split = contradictions_.up_to(stamp).size();
    for (std::size_t i = split; i > 0 && stamp_distance(all[i - 1].stamp, stamp) <= memory; --i)
      if (all[i - 1].value.is_certain || is_near(all[i - 1])) return &all[i - 1];
    return split < all.size() && is_near(all[split]) ? &all[split] : nullptr;
  }

 private:
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

  using Source = ToldSource<Value>;

  /// Who tells a stamp, and its states there; none: it is waited for.
  struct Word {
    const Source* source = nullptr;
    Bracket around;
  };

  /// The longest way between two states of a source that others are compared with.
  [[nodiscard]] std::int64_t longest() const { return max_gap_ > never / 2 ? never : 2 * max_gap_; }

  std::size_t find_or_add(std::uint32_t number, std::int64_t stamp) {
    for (std::size_t i = 0; i < sources_.size(); ++i)
      if (sources_[i].number == number) return i;
    if (sources_.size() == most_sources) {
      // Without comparing the first one is kept.
      const auto longest_silent =
          std::min_element(sources_.begin() + (compares_ ? 0 : 1), sources_.end(),
                           [](const Source& a, const Source& b) { return a.end() < b.end(); });
      sources_.erase(longest_silent);
    }
    sources_.push_back({number, {}, stamp});
    return sources_.size() - 1;
  }

  [[nodiscard]] Word word_at(std::int64_t stamp) const {
    if (sources_.empty()) return {};
    if (!compares_) {
      const Source& first = first_at(stamp);
      return {&first, first.track.around(stamp, max_gap_)};
    }
    const auto is_asked = [&](const Source& source) {
      return source.began <= stamp && !source.is_copy() && source.succeeded > stamp;
    };
    // What is disputed needs a value, too, and waits for nobody.
    const bool is_disputed = contradiction_near(stamp) != nullptr;
    Word word;
    for (const Source& source : sources_) {
      if (!is_asked(source)) continue;
      Bracket around = source.track.around(stamp, longest());
      if (around && is_pause(source.track, around, max_gap_)) around = {};
      if (around && (!word.around || around.gap() < word.around.gap())) word = {&source, around};
      if (!around && !is_disputed) return {&source, {}};
    }
    if (!word.around || word.around.gap() > static_cast<std::uint64_t>(max_gap_))
      return {word.source, {}};
    if (is_disputed) return word;
    const Value told = value_at(rule_, word.around, stamp);
    for (const Source& source : sources_)
      if (is_asked(source) &&
          rule_.distance(told, value_at(rule_, source.track.around(stamp, longest()), stamp)) >
              rule_.noise())
        return {&source, {}};
    return word;
  }

  /// Without comparing: the first source, or while it is silent the first one that began since.
  [[nodiscard]] const Source& first_at(std::int64_t stamp) const {
    const Source* first = &sources_.front();
    while (true) {
      const auto before = first->track.up_to(stamp);
      if (before.empty() || first->track.around(stamp, max_gap_) ||
          !first->is_silent(max_gap_, before.back().stamp, stamp))
        return *first;
      const Source* next = nullptr;
      for (const Source& source : sources_)
        if (source.began > before.back().stamp && source.began <= stamp &&
            (next == nullptr || source.began < next->began))
          next = &source;
      if (next == nullptr) return *first;
      first = next;
    }
  }

  /// Whether a source tells what another one told before, since it began itself; `for_sure`: not
  /// by chance.
  [[nodiscard]] bool is_echo(const Source& by, const State& state, bool for_sure) const {
    const std::int64_t since = std::max(by.began, stamp_after(state.stamp, -longest_lag));
    return std::any_of(sources_.begin(), sources_.end(), [&](const Source& source) {
      return &source != &by && has_told(rule_, source.track, since, state.stamp, state.value) &&
             (!for_sure || is_telling(rule_, source.track, since, state.stamp, state.value));
    });
  }

  /// Takes a state of a source, before it is put, as evidence of whether it is a copy, if it moved
  /// to where it was not before.
  void weigh(Source& by, const State& state) {
    if (by.weighed && rule_.distance(*by.weighed, state.value) <= rule_.noise()) return;
    by.weighed = state.value;
    if (has_told(rule_, by.track, stamp_after(state.stamp, -2 * longest_lag), state.stamp,
                 state.value))
      return;
    if (is_echo(by, state, true))
      by.evidence.add_echo();
    else if (!is_echo(by, state, false))
      by.evidence.add_own(state.stamp);
  }

  /// Counts what a source told on its own where another one was heard, or if there is none.
  void settle(Source& by) {
    by.evidence.settle([&](std::int64_t stamp) -> std::optional<bool> {
      bool is_alone = true, waits = false;
      for (const Source& source : sources_) {
        if (&source == &by || source.is_copy()) continue;
        is_alone = false;
        const auto around = source.track.around(stamp, longest());
        if (around && !is_pause(source.track, around, 2 * jitter)) return true;
        const std::int64_t end = source.end();
        waits = waits || (end < stamp && !source.is_silent(max_gap_, end, stamp));
      }
      return waits ? std::nullopt : std::optional(is_alone);
    });
  }

  /// Notes whom a source succeeds by a state: one that is silent, and that it is no copy of, as it
  /// began later, or moved on its own beside others, and since.
  void succeed(const Source& by, const State& state) {
    if (by.is_copy()) return;
    for (Source& source : sources_) {
      if (&source == &by || source.is_copy() || source.succeeded != never ||
          !source.is_silent(max_gap_, source.end(), state.stamp))
        continue;
      source.missed_since = std::min(source.missed_since, state.stamp);
      // It may be silent by its stamps alone, as late as its messages come.
      if (stamp_distance(source.missed_since, state.stamp) < 2 * source.period + jitter) continue;
      if (by.began > source.end() || moves_on(by, state, stamp_after(source.end(), longest())))
        source.succeeded = state.stamp;
    }
  }

  /// Whether a source that is no copy moved from its first state after a stamp to this one.
  [[nodiscard]] bool moves_on(const Source& by, const State& state, std::int64_t after) const {
    const auto since = by.track.states().subspan(by.track.up_to(after).size());
    return by.evidence.is_own() && !since.empty() &&
           rule_.distance(since.front().value, state.value) > rule_.noise() &&
           !is_echo(by, state, false);
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
      if (other == teller || sources_[teller].is_copy() || sources_[other].is_copy()) continue;
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
    const std::uint64_t own_gap = last == nullptr ? 0 : gap(*last, state);
    const std::uint64_t lag =
        static_cast<std::uint64_t>(jitter) + std::max(2 * gap_before(theirs, around), own_gap);
    const Value told = value_at(rule_, around, state.stamp);
    const double apart = rule_.distance(state.value, told);
    if (apart <= rule_.noise()) return;
    const double own = travel(rule_, own_track, state.stamp, lag, state.value);
    const double other_ones = travel(rule_, theirs, state.stamp, lag, told);
    if (apart > rule_.noise() + own + other_ones) {
      note({state.stamp,
            {{sources_[teller].number, sources_[other].number},
             {state.value, told},
             last != nullptr && is_known_for(own_track, state.stamp, lag) &&
                 is_known_for(theirs, state.stamp, lag)}});
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

  /// The time between states there, 0 if it is not known.
  [[nodiscard]] std::uint64_t gap_before(const Track& track, const Bracket& around) const {
    if (around.before != around.after) return around.gap();
    const State* const last = track.last_before(around.before->stamp);
    return last == nullptr ? 0 : gap(*last, *around.before);
  }

  /// Between two states of a source.
  [[nodiscard]] std::uint64_t gap(const State& a, const State& b) const {
    return std::min(stamp_distance(a.stamp, b.stamp), static_cast<std::uint64_t>(longest()));
  }

  Rule rule_;
  std::int64_t max_gap_;
  bool compares_;
  std::uint32_t only_ = 0;  // who tells all, where sources_ is empty
  Track all_;
  std::vector<Source> sources_;  // empty, or two at least, or one that is a copy
  StampedTrack<Contradiction> contradictions_;
};

}  // namespace penumbra
