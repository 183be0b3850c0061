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

double JointRule::way(double from, double to) const {
  return kind == Kind::turning ? short_way(from, to) : to - from;
}

double JointRule::distance(double a, double b) const {
  // A quaternion and its negative are one rotation.
  if (kind == Kind::quaternion) return std::min(std::abs(b - a), std::abs(b + a));
  return std::abs(way(a, b));
}

double JointRule::noise() const {
  if (kind == Kind::linear) return shift_noise;
  return kind == Kind::quaternion ? turn_noise / 2.0 : turn_noise;  // half the angle
}

JointBuffer::JointBuffer(const Robot& robot, JointBufferOptions options)
    : max_gap_(span_nanoseconds(options.max_gap, "joint buffer: max_gap")),
      history_(span_nanoseconds(options.history, "joint buffer: history")),
      max_states_(options.max_states),
      kinds_(robot.variables().size(), Kind::linear) {
  if (max_states_ == 0) throw InputError("joint buffer: max_states is 0; expected at least 1");
  for (std::size_t i = 0; i < kinds_.size(); ++i) index_.emplace(robot.variables()[i], i);
  for (const Joint& joint : robot.joints()) {
    if (!joint.variable || joint.mimics) continue;
    if (joint.type == JointType::revolute) kinds_[*joint.variable] = Kind::revolute;
    if (joint.type == JointType::continuous) kinds_[*joint.variable] = Kind::turning;
    if (joint.type == JointType::planar) kinds_[*joint.variable + 2] = Kind::turning;
    if (joint.type != JointType::floating) continue;
    quaternions_.push_back(*joint.variable + 3);
    std::fill_n(kinds_.begin() + static_cast<std::ptrdiff_t>(quaternions_.back()), 4,
                Kind::quaternion);
  }
  for (const Kind kind : kinds_)
    tracks_.emplace_back(JointRule{kind}, max_gap_, options.compare_sources);
}

std::size_t JointBuffer::insert(std::int64_t stamp, std::span<const std::string> names,
                                std::span<const double> positions, std::string_view source) {
  const std::uint32_t teller = sources_.number_of(source);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = index_.find(names[i]);
    if (at == index_.end()) continue;
    if (i >= positions.size() || !(std::abs(positions[i]) <= kLargestValue)) {
      ++refused_values_;
    } else {
      tracks_[at->second].put({stamp, positions[i]}, teller);
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
  for (Track& track : tracks_) track.prune(limit, max_states_);
}

void JointBuffer::at(std::int64_t stamp, JointAnswer& answer) const {
  answer.gaps.clear();
  answer.disputes.clear();
  answer.age = 0;
  answer.positions.resize(tracks_.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (kinds_[i] != Kind::quaternion && !interpolate(i, stamp, answer)) add_gap(i, stamp, answer);
  for (const std::size_t first : quaternions_)
    if (!interpolate_quaternion(first, stamp, answer))
      for (std::size_t i = first; i < first + 4; ++i) add_gap(i, stamp, answer);
  for (std::size_t i = 0; i < tracks_.size(); ++i) add_dispute(i, stamp, answer);
  answer.status = answer.disputes.empty() ? JointStatus::ok : JointStatus::disputed;
  if (!answer.gaps.empty()) answer.status = JointStatus::stale;
  for (const JointGap& gap : answer.gaps)
    if (gap.why == JointStatus::missing) answer.status = JointStatus::missing;
}

bool JointBuffer::near(std::int64_t before, std::int64_t after) const {
  return stamp_distance(before, after) <= static_cast<std::uint64_t>(max_gap_);
}

bool JointBuffer::interpolate(std::size_t variable, std::int64_t stamp, JointAnswer& answer) const {
  const auto around = tracks_[variable].track_at(stamp).around(stamp, max_gap_);
  if (!around) return false;
  const auto &a = *around.before, &b = *around.after;
  answer.positions[variable] = a.value;
  if (a.stamp == stamp) return true;
  answer.positions[variable] =
      JointRule{kinds_[variable]}.between(a.value, stamp_share(a.stamp, stamp, b.stamp), b.value);
  answer.age = std::max({answer.age, stamp - a.stamp, b.stamp - stamp});
  return true;
}

std::optional<Eigen::Quaterniond> JointBuffer::quaternion(std::size_t first,
                                                          std::int64_t stamp) const {
  Eigen::Vector4d xyzw;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto part = tracks_[first + i].all().value_at(stamp);
    if (!part) return std::nullopt;
    xyzw[static_cast<Eigen::Index>(i)] = *part;
  }
  return Eigen::Quaterniond(xyzw);
}

std::optional<std::int64_t> JointBuffer::last_quaternion(std::size_t first,
                                                         std::int64_t stamp) const {
  const auto before = tracks_[first].all().up_to(stamp);
  for (auto state = before.rbegin(); state != before.rend(); ++state)
    if (quaternion(first, state->stamp)) return state->stamp;
  return std::nullopt;
}

std::optional<JointBuffer::Bracket> JointBuffer::bracket_quaternion(std::size_t first,
                                                                    std::int64_t stamp) const {
  const auto all = tracks_[first].all().states();
  const std::size_t split = tracks_[first].all().up_to(stamp).size();
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
  if (!tracks_[variable].all().states().empty()) gap.why = JointStatus::stale;
  if (const auto before = tracks_[variable].all().up_to(stamp); !before.empty())
    gap.last_seen = before.back().stamp;
  answer.gaps.push_back(gap);
}

void JointBuffer::add_dispute(std::size_t variable, std::int64_t stamp, JointAnswer& answer) const {
  const auto* const found = tracks_[variable].contradiction_near(stamp);
  if (found == nullptr) return;
  const auto& sources = found->value.sources;
  answer.disputes.push_back({variable,
                             found->stamp,
                             {sources_.name_of(sources[0]), sources_.name_of(sources[1])},
                             found->value.values});
}

std::optional<std::int64_t> JointBuffer::complete_until() const {
  std::optional<std::int64_t> until;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const auto states = tracks_[i].all().states();
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
    if (at == index_.end() || tracks_[at->second].all().states().empty()) continue;
    const std::int64_t stamp = tracks_[at->second].all().states().back().stamp;
    newest = std::max(newest.value_or(stamp), stamp);
  }
  return newest;
}

void JointBuffer::clear() {
  for (Track& track : tracks_) track.clear();
  newest_.reset();
}

}  // namespace penumbra
