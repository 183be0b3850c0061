// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/robot/joint_track.hpp>

namespace penumbra {
namespace {

constexpr auto kEarlier = [](const JointTrack::State& state, std::int64_t stamp) {
  return state.stamp < stamp;
};

}  // namespace

void JointTrack::put(State state) {
  const auto begin = states_.begin() + static_cast<std::ptrdiff_t>(first_);
  const auto at = std::lower_bound(begin, states_.end(), state.stamp, kEarlier);
  if (at != states_.end() && at->stamp == state.stamp)
    *at = state;
  else
    states_.insert(at, state);
}

void JointTrack::remove(std::int64_t stamp) {
  const auto begin = states_.begin() + static_cast<std::ptrdiff_t>(first_);
  const auto at = std::lower_bound(begin, states_.end(), stamp, kEarlier);
  if (at != states_.end() && at->stamp == stamp) states_.erase(at);
}

void JointTrack::prune(std::int64_t limit, std::size_t max_states) {
  while (first_ + 1 < states_.size() && states_[first_ + 1].stamp <= limit) ++first_;
  if (states_.size() - first_ > max_states) first_ = states_.size() - max_states;
  if (first_ > states_.size() / 2) {
    states_.erase(states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
}

void JointTrack::clear() {
  states_.clear();
  first_ = 0;
}

std::span<const JointTrack::State> JointTrack::states() const {
  return std::span(states_).subspan(first_);
}

std::span<const JointTrack::State> JointTrack::up_to(std::int64_t stamp) const {
  const auto all = states();
  const auto end = std::upper_bound(
      all.begin(), all.end(), stamp,
      [](std::int64_t wanted, const State& state) { return wanted < state.stamp; });
  return all.first(static_cast<std::size_t>(end - all.begin()));
}

std::optional<double> JointTrack::value_at(std::int64_t stamp) const {
  const auto before = up_to(stamp);
  if (before.empty() || before.back().stamp != stamp) return std::nullopt;
  return before.back().value;
}

}  // namespace penumbra
