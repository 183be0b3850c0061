// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps-inl.hpp>
#include <penumbra/robot/joint_buffer.hpp>

namespace penumbra {
namespace {

constexpr double kLargestValue = 1e9;    // as forward_kinematics has it
constexpr double kUnitTolerance = 0.01;  // of a quaternion's length

double short_way(double from, double to) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return std::remainder(std::remainder(to, kTurn) - std::remainder(from, kTurn), kTurn);
}

}  // namespace

JointBuffer::JointBuffer(const Robot& robot, JointBufferOptions options)
    : max_gap_(span_nanoseconds(options.max_gap, "joint buffer: max_gap")),
      history_(span_nanoseconds(options.history, "joint buffer: history")),
      max_states_(options.max_states),
      tracks_(robot.variables().size()),
      kinds_(robot.variables().size(), Kind::linear) {
  if (max_states_ == 0) throw InputError("joint buffer: max_states is 0; expected at least 1");
  for (std::size_t i = 0; i < tracks_.size(); ++i) index_.emplace(robot.variables()[i], i);
  for (const Joint& joint : robot.joints()) {
    if (!joint.variable || joint.mimics) continue;
    if (joint.type == JointType::continuous) kinds_[*joint.variable] = Kind::turning;
    if (joint.type == JointType::planar) kinds_[*joint.variable + 2] = Kind::turning;
    if (joint.type != JointType::floating) continue;
    quaternions_.push_back(*joint.variable + 3);
    std::fill_n(kinds_.begin() + static_cast<std::ptrdiff_t>(quaternions_.back()), 4,
                Kind::quaternion);
  }
}

std::size_t JointBuffer::insert(std::int64_t stamp, std::span<const std::string> names,
                                std::span<const double> positions) {
  std::size_t taken = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = index_.find(names[i]);
    if (at == index_.end()) continue;
    if (i >= positions.size() || !(std::abs(positions[i]) <= kLargestValue)) {
      ++refused_values_;
    } else {
      tracks_[at->second].put({stamp, positions[i]});
      ++taken;
    }
  }
  if (taken == 0) return 0;
  const std::size_t refused = refuse_quaternions(stamp);
  refused_values_ += refused;
  newest_ = std::max(newest_.value_or(stamp), stamp);
  prune();
  return taken - std::min(taken, refused);
}

std::size_t JointBuffer::refuse_quaternions(std::int64_t stamp) {
  std::size_t refused = 0;
  for (const std::size_t first : quaternions_) {
    const auto q = quaternion(first, stamp);
    if (!q || std::abs(q->norm() - 1.0) <= kUnitTolerance) continue;
    for (std::size_t i = first; i < first + 4; ++i) tracks_[i].remove(stamp);
    refused += 4;
  }
  return refused;
}

void JointBuffer::prune() {
  const std::int64_t limit = stamp_after(*newest_, -history_);
  for (auto& track : tracks_) track.prune(limit, max_states_);
}

void JointBuffer::at(std::int64_t stamp, JointAnswer& answer) const {
  answer.gaps.clear();
  answer.age = 0;
  answer.positions.resize(tracks_.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (kinds_[i] != Kind::quaternion && !interpolate(i, stamp, answer)) add_gap(i, stamp, answer);
  for (const std::size_t first : quaternions_)
    if (!interpolate_quaternion(first, stamp, answer))
      for (std::size_t i = first; i < first + 4; ++i) add_gap(i, stamp, answer);
  answer.status = answer.gaps.empty() ? JointStatus::ok : JointStatus::stale;
  for (const JointGap& gap : answer.gaps)
    if (gap.why == JointStatus::missing) answer.status = JointStatus::missing;
}

bool JointBuffer::near(std::int64_t before, std::int64_t after) const {
  return stamp_distance(before, after) <= static_cast<std::uint64_t>(max_gap_);
}

bool JointBuffer::interpolate(std::size_t variable, std::int64_t stamp, JointAnswer& answer) const {
  const auto all = tracks_[variable].states();
  const auto before = tracks_[variable].up_to(stamp);
  if (before.empty()) return false;
  const auto& a = before.back();
  answer.positions[variable] = a.value;
  if (a.stamp == stamp) return true;
  if (before.size() == all.size()) return false;
  const auto& b = all[before.size()];
  if (!near(a.stamp, b.stamp)) return false;
  const double way =
      kinds_[variable] == Kind::turning ? short_way(a.value, b.value) : b.value - a.value;
  answer.positions[variable] += stamp_share(a.stamp, stamp, b.stamp) * way;
  answer.age = std::max({answer.age, stamp - a.stamp, b.stamp - stamp});
  return true;
}

std::optional<Eigen::Quaterniond> JointBuffer::quaternion(std::size_t first,
                                                          std::int64_t stamp) const {
  Eigen::Vector4d xyzw;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto part = tracks_[first + i].value_at(stamp);
    if (!part) return std::nullopt;
    xyzw[static_cast<Eigen::Index>(i)] = *part;
  }
  return Eigen::Quaterniond(xyzw);
}

std::optional<std::int64_t> JointBuffer::last_quaternion(std::size_t first,
                                                         std::int64_t stamp) const {
  const auto before = tracks_[first].up_to(stamp);
  for (auto state = before.rbegin(); state != before.rend(); ++state)
    if (quaternion(first, state->stamp)) return state->stamp;
  return std::nullopt;
}

std::optional<JointBuffer::Bracket> JointBuffer::bracket_quaternion(std::size_t first,
                                                                    std::int64_t stamp) const {
  const auto all = tracks_[first].states();
  const std::size_t split = tracks_[first].up_to(stamp).size();
  std::optional<std::int64_t> before;
  for (std::size_t i = split; !before && i > 0 && near(all[i - 1].stamp, stamp); --i)
    if (quaternion(first, all[i - 1].stamp)) before = all[i - 1].stamp;
  if (!before) return std::nullopt;
  if (*before == stamp) return Bracket{stamp, stamp};
  for (std::size_t i = split; i < all.size() && near(*before, all[i].stamp); ++i)
    if (quaternion(first, all[i].stamp)) return Bracket{*before, all[i].stamp};
  return std::nullopt;
}

bool JointBuffer::interpolate_quaternion(std::size_t first, std::int64_t stamp,
                                         JointAnswer& answer) const {
  const auto bracket = bracket_quaternion(first, stamp);
  if (!bracket) return false;
  const auto [before, after] = *bracket;
  Eigen::Quaterniond q = quaternion(first, before)->normalized();
  if (before != after)
    q = q.slerp(stamp_share(before, stamp, after), quaternion(first, after)->normalized());
  for (std::size_t i = 0; i < 4; ++i)
    answer.positions[first + i] = q.coeffs()[static_cast<Eigen::Index>(i)];
  answer.age = std::max({answer.age, stamp - before, after - stamp});
  return true;
}

void JointBuffer::add_gap(std::size_t variable, std::int64_t stamp, JointAnswer& answer) const {
  JointGap gap{variable, JointStatus::missing, std::nullopt};
  if (!tracks_[variable].states().empty()) gap.why = JointStatus::stale;
  if (const auto before = tracks_[variable].up_to(stamp); !before.empty())
    gap.last_seen = before.back().stamp;
  answer.gaps.push_back(gap);
}

std::optional<std::int64_t> JointBuffer::complete_until() const {
  std::optional<std::int64_t> until;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const auto states = tracks_[i].states();
    if (states.empty()) return std::nullopt;
    until = std::min(until.value_or(states.back().stamp), states.back().stamp);
  }
  for (const std::size_t first : quaternions_) {
    const auto whole = last_quaternion(first, *until);
    if (!whole) return std::nullopt;
    until = whole;
  }
  return until;
}

std::optional<std::int64_t> JointBuffer::newest_of(std::span<const std::string> names) const {
  std::optional<std::int64_t> newest;
  for (const std::string& name : names) {
    const auto at = index_.find(name);
    if (at == index_.end() || tracks_[at->second].states().empty()) continue;
    const std::int64_t stamp = tracks_[at->second].states().back().stamp;
    newest = std::max(newest.value_or(stamp), stamp);
  }
  return newest;
}

void JointBuffer::clear() {
  for (auto& track : tracks_) track.clear();
  newest_.reset();
}

}  // namespace penumbra
