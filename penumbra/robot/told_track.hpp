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
/// A value is known where all sources tell it, but for those that are seen to lag: within the
/// rule's noise of each other. The one whose states are closest there gives it. A source that
/// falls silent is waited for until one succeeds it that begins after it, or moves on its own: what
/// stands still may be its copy. Who told nothing within the history is forgotten.
///
/// A source lags that is where another one was before, and moves: it is a copy. It leads when it
/// moves on its own while all others are silent.
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

  /// Nanoseconds for which a silent source is remembered however short the history is: longer than
  /// a slow driver's time between two states.
  static constexpr std::int64_t shortest_history = 2'000'000'000;

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
    if (!own.track.states().empty() && state.stamp > end_of(own)) {
      own.period = stamp_distance(end_of(own), state.stamp);
      own.succeeded = never;
    }
    own.track.put(state);
    own.began = std::min(own.began, state.stamp);
    if (!compares_) return;
    compare(teller, state);
    succeed(own, state);
  }

  /// As of a StampedTrack; a source that told nothing since `limit` is forgotten, if one is left
  /// that does not lag.
  void prune(std::int64_t limit, std::size_t max_states) {
    all_.prune(limit, max_states);
    contradictions_.prune(limit, max_states);
    if (sources_.empty()) return;
    for (Source& source : sources_) source.track.prune(limit, max_states);
    if (!compares_) return;  // who was there beside the first one is known for ever
    const std::int64_t heard_since =
        std::min(limit, stamp_after(all_.states().back().stamp, -shortest_history));
    const auto is_left = [&](const Source& source) {
      return !source.lags() && end_of(source) >= heard_since;
    };
    const bool forgets = std::any_of(sources_.begin(), sources_.end(), is_left);  // not for copies
    std::erase_if(sources_, [&](const Source& source) {
      return end_of(source) < heard_since && (forgets || source.lags());
    });
    if (sources_.size() > 1) return;
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
  static constexpr std::int64_t always = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

  struct Source {
    std::uint32_t number;
    Track track;
    std::int64_t began;                // its first stamp
    std::uint64_t period = 0;          // between its last two states; 0: it told one
    std::int64_t leads_from = always;  // never: it was seen to lag
    std::int64_t succeeded =
        never;  // since it is silent: the stamp from which another one may tell

    [[nodiscard]] bool lags() const { return leads_from == never; }
  };

  /// Who tells a stamp, and its states there; none: it is waited for.
  struct Word {
    const Source* source = nullptr;
    Bracket around;
  };

  /// The longest way between two states of a source that others are compared with.
  [[nodiscard]] std::int64_t longest() const { return max_gap_ > never / 2 ? never : 2 * max_gap_; }

  [[nodiscard]] static std::int64_t end_of(const Source& source) {
    return source.track.states().back().stamp;
  }

  /// Whether a source is silent at a stamp, up to which it told nothing since `last`.
  [[nodiscard]] bool is_silent(const Source& source, std::int64_t last, std::int64_t stamp) const {
    const std::uint64_t due =
        source.period == 0 ? static_cast<std::uint64_t>(shortest_history) : 2 * source.period;
    return last < stamp &&
           stamp_distance(last, stamp) > std::max(due, static_cast<std::uint64_t>(max_gap_));
  }

  std::size_t find_or_add(std::uint32_t number, std::int64_t stamp) {
    for (std::size_t i = 0; i < sources_.size(); ++i)
      if (sources_[i].number == number) return i;
    if (sources_.size() == most_sources) {
      // Without comparing the first one is kept.
      const auto longest_silent =
          std::min_element(sources_.begin() + (compares_ ? 0 : 1), sources_.end(),
                           [](const Source& a, const Source& b) { return end_of(a) < end_of(b); });
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
      return source.began <= stamp && source.leads_from <= stamp && !source.lags() &&
             source.succeeded > stamp;
    };
    // What is disputed needs a value, too, and waits for nobody.
    const bool is_disputed = contradiction_near(stamp) != nullptr;
    Word word;
    for (const Source& source : sources_) {
      if (!is_asked(source)) continue;
      const Bracket around = source.track.around(stamp, longest());
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
          !is_silent(*first, before.back().stamp, stamp))
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

  /// Notes whom a source succeeds by a state: one that is silent, and that it is no copy of, as it
  /// began later, or moved since. A copy may move on for as long as it lags.
  void succeed(Source& by, const State& state) {
    const auto is_out = [&](const Source& source) {
      return &source == &by || source.lags() || is_silent(source, end_of(source), state.stamp);
    };
    if (by.lags() && !std::all_of(sources_.begin(), sources_.end(), is_out)) return;
    for (Source& source : sources_) {
      if (&source == &by || source.lags() || source.succeeded != never ||
          !is_silent(source, end_of(source), state.stamp))
        continue;
      if (by.began <= end_of(source)) {
        const std::int64_t caught_up = stamp_after(end_of(source), longest());
        if (state.stamp <= caught_up) continue;
        const auto before = by.track.up_to(caught_up);
        const Value& from = before.empty() ? by.track.states().front().value : before.back().value;
        if (rule_.distance(from, state.value) <= rule_.noise()) continue;
      }
      source.succeeded = state.stamp;
      by.leads_from = std::min(by.leads_from, state.stamp);
    }
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
    } else if (around.gap() <= 2 * own_gap) {
      find_ahead(state, told, {teller, other}, 2 * lag);
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

  /// Of two sources that agree, but are apart, notes that the one lags that the other one is ahead
  /// of, if it moves: what stands may be nobody's copy.
  void find_ahead(const State& state, const Value& told, const std::array<std::size_t, 2>& of,
                  std::uint64_t lag) {
    const std::array values = {state.value, told};
    const std::array<const Track*, 2> paths = {&sources_[of[0]].track, &sources_[of[1]].track};
    const auto ahead = who_is_ahead(rule_, paths, state.stamp, values, lag);
    if (!ahead) return;
    Source& behind = sources_[of[1 - *ahead]];
    if (travel(rule_, behind.track, state.stamp, lag, values[1 - *ahead]) <= rule_.noise()) return;
    behind.leads_from = never;
    if (std::all_of(sources_.begin(), sources_.end(), [](const Source& s) { return s.lags(); }))
      sources_[of[*ahead]].leads_from = always;
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
  std::vector<Source> sources_;  // empty, or two at least
  StampedTrack<Contradiction> contradictions_;
};

}  // namespace penumbra
