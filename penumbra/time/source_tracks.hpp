// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <penumbra/base/stamps.hpp>
#include <penumbra/time/stamped_track.hpp>

namespace penumbra {

/// Largest difference of the stamps of one instant in two programs, nanoseconds.
inline constexpr std::int64_t stamp_jitter = 20'000'000;

/// Part of messages about a believed source that is silent while others publish.
inline constexpr std::string_view others_unused =
    "; its other publishers are used only if they started after that";

/// The states of one joint or transform over time, separate for each source (publisher's name).
///
/// The first source is believed. Once it is silent, a source that began after its last state is
/// believed instead. The states of other sources are only compared with the believed source, at
/// their own stamps. They agree within the rule's noise plus the change of the believed value in
/// the lag: stamp_jitter plus two periods of the believed source plus one of the other.
///
/// Rule: double distance(Value, Value), Value interpolate(Value, double fraction, Value),
/// double noise(), bool one_value_of_a_stamp.
template <typename Value, typename Rule>
class SourceTracks {
 public:
  using Track = StampedTrack<Value>;
  using State = typename Track::State;
  using Bracket = typename Track::Bracket;
  using Name = std::shared_ptr<const std::string>;

  /// Nanoseconds after its last state from which a source is silent, or max_gap or two periods of
  /// the source if that is longer.
  static constexpr std::int64_t silence = 500'000'000;
  /// The period of a source that has published once, nanoseconds.
  static constexpr std::int64_t unknown_period = 1'000'000'000;
  /// Nanoseconds after a disagreement for which the value stays disputed: two values may be equal
  /// in passing, and messages may be lost.
  static constexpr std::int64_t memory = 800'000'000;
  /// Maximum number of sources; then the one that is silent for longest is dropped.
  static constexpr std::size_t most_sources = 32;

  struct Source {
    Name name;
    std::int64_t began;  ///< its earliest stamp
    Track track;         ///< never empty

    [[nodiscard]] std::int64_t end() const { return track.states().back().stamp; }
  };

  /// Values of the believed source and another one for the same stamp.
  struct Disagreement {
    std::array<Name, 2> sources;
    std::array<Value, 2> values;
  };

  /// `max_gap`: nanoseconds between two states that may be interpolated. `compares`: false for no
  /// disagreements.
  explicit SourceTracks(Rule rule, std::int64_t max_gap, bool compares = true)
      : rule_(std::move(rule)), max_gap_(max_gap), compares_(compares) {}

  /// Adds a state; replaces the one of the same stamp and source.
  void put(const State& state, std::string_view name) {
    Source& own = find_or_add(name.empty() ? "an unnamed publisher" : name, state.stamp);
    if (compares_ && Rule::one_value_of_a_stamp) compare_with_former(own, state);
    own.began = std::min(own.began, state.stamp);
    own.track.put(state);
    newest_ = std::max(newest_.value_or(state.stamp), state.stamp);
    if (sources_.size() == 1) return;
    const bool is_successor = succeeds(own, state.stamp);
    if (is_successor) believed_.put({own.began, own.name});
    if (compares_) compare(own, state, is_successor);
  }

  /// As StampedTrack::prune, for each source.
  void prune(std::int64_t limit, std::size_t max_states) {
    for (Source& source : sources_) source.track.prune(limit, max_states);
    believed_.prune(limit, max_states);
    disagreements_.prune(limit, max_states);
  }

  /// Removes the sources as well.
  void clear() {
    sources_.clear();
    believed_.clear();
    disagreements_.clear();
    newest_.reset();
  }

  /// Returns the newest stamp of any source.
  [[nodiscard]] std::optional<std::int64_t> newest() const { return newest_; }
  [[nodiscard]] bool has_several_sources() const { return sources_.size() > 1; }

  /// Returns the source that is believed at a stamp, or null if its states were dropped.
  [[nodiscard]] const Source* believed_at(std::int64_t stamp) const {
    const auto until = believed_.up_to(stamp);
    return until.empty() ? nullptr : find(until.back().value);
  }

  /// Returns the believed states around a stamp, or an empty bracket.
  [[nodiscard]] Bracket around(std::int64_t stamp) const {
    const Source* const believed = believed_at(stamp);
    return believed == nullptr ? Bracket{} : believed->track.around(stamp, max_gap_);
  }

  /// Returns the value between two states.
  [[nodiscard]] Value interpolate(const Bracket& around, std::int64_t stamp) const {
    const auto &a = *around.before, &b = *around.after;
    if (a.stamp == stamp) return a.value;
    return rule_.interpolate(a.value, stamp_share(a.stamp, stamp, b.stamp), b.value);
  }

  /// Returns a disagreement at most `memory` before or max_gap after a stamp, or null.
  [[nodiscard]] const typename StampedTrack<Disagreement>::State* disagreement_near(
      std::int64_t stamp) const {
    const auto before = disagreements_.between(stamp_after(stamp, -memory), stamp);
    if (!before.empty()) return &before.back();
    const auto after = disagreements_.between(stamp, stamp_after(stamp, max_gap_));
    return after.empty() ? nullptr : &after.front();
  }

 private:
  Source& find_or_add(std::string_view name, std::int64_t stamp) {
    for (Source& source : sources_)
      if (*source.name == name) return source;
    if (sources_.size() == most_sources) drop_one();
    sources_.push_back({std::make_shared<const std::string>(name), stamp, {}});
    if (believed_.states().empty())
      believed_.put({std::numeric_limits<std::int64_t>::min(), sources_.back().name});
    return sources_.back();
  }

  void drop_one() {
    const auto age = [this](const Source& source) {
      return std::pair(source.name == believed_.states().back().value, source.end());
    };
    sources_.erase(
        std::min_element(sources_.begin(), sources_.end(),
                         [&](const Source& a, const Source& b) { return age(a) < age(b); }));
  }

  [[nodiscard]] const Source* find(const Name& name) const {
    for (const Source& source : sources_)
      if (source.name == name) return &source;
    return nullptr;
  }

  /// Whether a source began after the last state of the believed one, which is silent.
  [[nodiscard]] bool succeeds(const Source& own, std::int64_t stamp) const {
    const Source& believed = *find(believed_.states().back().value);
    const std::int64_t last = believed.end();
    const std::int64_t due = std::max({silence, max_gap_, 2 * period(believed.track, last)});
    return own.began > last && stamp > stamp_after(last, due);
  }

  /// Returns the nanoseconds between the last two states up to a stamp.
  [[nodiscard]] static std::int64_t period(const Track& track, std::int64_t stamp) {
    const auto until = track.up_to(stamp);
    const std::size_t n = until.size();
    if (n < 2) return unknown_period;
    constexpr std::uint64_t longest = 1'000'000'000'000'000'000;
    const auto gap = std::min(longest, stamp_distance(until[n - 2].stamp, until[n - 1].stamp));
    return static_cast<std::int64_t>(gap);
  }

  /// Compares a new state with the believed source. If that is its own source, compares the states
  /// of the others up to its neighbours, or since it began.
  void compare(const Source& own, const State& state, bool is_successor) {
    const Source* const believed = believed_at(state.stamp);
    if (believed == nullptr) return;
    if (believed != &own) return compare_with_believed(state, own, *believed);
    const State* const last = own.track.last_before(state.stamp);
    const State* const next = own.track.first_after(state.stamp);
    const std::int64_t from = is_successor ? own.began : (last == nullptr ? state : *last).stamp;
    for (const Source& other : sources_)
      if (&other != &own)
        for (const State& each : other.track.between(from, (next == nullptr ? state : *next).stamp))
          compare_with_believed(each, other, own);
  }

  /// Notes a disagreement of another source's state with the believed one, if that is known there.
  void compare_with_believed(const State& state, const Source& source, const Source& believed) {
    const std::int64_t longest = 2 * max_gap_;
    const Bracket around = believed.track.around(state.stamp, longest);
    if (!around) return;
    const Value expected = interpolate(around, state.stamp);
    const double apart = rule_.distance(state.value, expected);
    if (apart <= rule_.noise()) return;
    const std::int64_t lag = stamp_jitter +
                             2 * std::min(longest, period(believed.track, around.after->stamp)) +
                             std::min(longest, period(source.track, state.stamp));
    double moved = 0.0;
    for (const State& near :
         believed.track.between(stamp_after(state.stamp, -lag), stamp_after(state.stamp, lag)))
      moved = std::max(moved, rule_.distance(near.value, expected));
    if (apart > rule_.noise() + moved)
      disagreements_.put({state.stamp, {{believed.name, source.name}, {expected, state.value}}});
  }

  /// Notes a disagreement of a source with what it published before for the same stamp: values that
  /// are farther apart than either is from the previous state. Two publishers may share a name.
  void compare_with_former(const Source& own, const State& state) {
    const auto former = own.track.value_at(state.stamp);
    if (!former) return;
    double allowed = rule_.noise();
    if (const State* const last = own.track.last_before(state.stamp))
      allowed +=
          std::min(rule_.distance(last->value, *former), rule_.distance(last->value, state.value));
    if (rule_.distance(*former, state.value) > allowed)
      disagreements_.put({state.stamp, {{own.name, own.name}, {*former, state.value}}});
  }

  Rule rule_;
  std::int64_t max_gap_;
  bool compares_;
  std::vector<Source> sources_;
  StampedTrack<Name> believed_;  // each from its first state on
  StampedTrack<Disagreement> disagreements_;
  std::optional<std::int64_t> newest_;
};

}  // namespace penumbra
