// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/time/joint_buffer.hpp>
#include <penumbra/time/source_tracks.hpp>

namespace penumbra {
namespace {

constexpr double kUnitTolerance = 0.01;  // of a quaternion's length
constexpr std::size_t kMostOtherNames = 100;

double shorter_turn(double from, double to) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return std::remainder(std::remainder(to, kTurn) - std::remainder(from, kTurn), kTurn);
}

}  // namespace

/// As JointRule, for the rotation of a floating joint.
struct RotationRule {
  static constexpr bool one_value_of_a_stamp = false;

  [[nodiscard]] double distance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) const {
    return a.angularDistance(b);
  }
  [[nodiscard]] Eigen::Quaterniond interpolate(const Eigen::Quaterniond& a, double fraction,
                                               const Eigen::Quaterniond& b) const {
    return a.slerp(fraction, b);
  }
  [[nodiscard]] double noise() const { return JointRule::turn_noise; }
};

using RotationTrack = SourceTracks<Eigen::Quaterniond, RotationRule>;

/// The rotation of a floating joint.
struct JointBuffer::Rotation {
  std::size_t first;  // of its four variables: x, y, z, w
  RotationTrack track;
  // The newest state, whose parts may still arrive:
  std::int64_t stamp = 0;
  std::string source = {};
  std::array<bool, 4> known{};
  Eigen::Vector4d xyzw = Eigen::Vector4d::Zero();
};

JointBuffer::~JointBuffer() = default;
JointBuffer::JointBuffer(JointBuffer&&) noexcept = default;
JointBuffer& JointBuffer::operator=(JointBuffer&&) noexcept = default;

double JointRule::difference(double from, double to) const {
  return kind == Kind::turning ? shorter_turn(from, to) : to - from;
}

double JointRule::distance(double a, double b) const { return std::abs(difference(a, b)); }

double JointRule::noise() const { return kind == Kind::linear ? shift_noise : turn_noise; }

double JointRule::largest_step(double seconds) const {
  const double step = velocity * (seconds + 1e-9 * stamp_jitter) + noise();
  return kind == Kind::linear ? step : std::min(step, max_turn);
}

JointBuffer::JointBuffer(const Robot& robot, JointBufferOptions options)
    : max_gap_(span_nanoseconds(options.max_gap, "joint buffer: max_gap")),
      history_(span_nanoseconds(options.history, "joint buffer: history")),
      max_states_(options.max_states),
      rules_(robot.variables().size()),
      rotation_of_(robot.variables().size()),
      is_refused_(robot.variables().size()),
      last_state_(robot.variables().size()) {
  if (max_states_ == 0) throw InputError("joint buffer: max_states is 0; expected at least 1");
  using Kind = JointRule::Kind;
  for (std::size_t i = 0; i < rules_.size(); ++i) index_.emplace(robot.variables()[i], i);
  for (const Joint& joint : robot.joints()) {
    if (!joint.variable || joint.mimics) other_joints_.insert(joint.name);
    if (!joint.variable || joint.mimics) continue;
    JointRule& rule = rules_[*joint.variable];
    if (joint.velocity && joint.type != JointType::planar && joint.type != JointType::floating)
      rule.velocity = *joint.velocity;
    if (joint.type == JointType::revolute) rule.kind = Kind::revolute;
    if (joint.type == JointType::continuous) rule.kind = Kind::turning;
    if (joint.type == JointType::planar) rules_[*joint.variable + 2].kind = Kind::turning;
    if (joint.type != JointType::floating) continue;
    const std::size_t first = *joint.variable + 3;
    for (std::size_t i = first; i < first + 4; ++i) rotation_of_[i] = rotations_.size();
    rotations_.push_back({first, RotationTrack({}, max_gap_, options.compare_sources)});
  }
  for (const JointRule& rule : rules_)
    tracks_.emplace_back(rule, max_gap_, options.compare_sources);
}

std::size_t JointBuffer::insert(std::int64_t stamp, std::span<const std::string> names,
                                std::span<const double> positions, std::string_view source) {
  if (positions.size() > names.size()) positions = {};  // nobody knows which is whose
  std::size_t taken = 0;
  ++states_;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = index_.find(names[i]);
    if (at == index_.end()) {
      note_other(names[i]);
      continue;
    }
    const std::size_t variable = at->second;
    if (i >= positions.size() || !(std::abs(positions[i]) <= Robot::max_position)) {
      ++refused_values_;
      is_refused_[variable] = true;
      continue;
    }
    ++taken;
    const bool is_second = std::exchange(last_state_[variable], states_) == states_;
    if (!rotation_of_[variable]) {
      if (is_second)
        tracks_[variable].put({stamp, positions[i]}, std::string(source) + " in the same message");
      else
        tracks_[variable].put({stamp, positions[i]}, source);
      continue;
    }
    Rotation& rotation = rotations_[*rotation_of_[variable]];
    set_part(rotation, variable - rotation.first, stamp, source, positions[i]);
  }
  if (taken == 0) return 0;
  const std::size_t refused = take_rotations(stamp, source);
  refused_values_ += refused;
  newest_ = std::max(newest_.value_or(stamp), stamp);
  prune();
  return taken - std::min(taken, refused);
}

void JointBuffer::note_other(const std::string& name) {
  if (other_names_.size() < kMostOtherNames && !other_joints_.contains(name) &&
      std::ranges::find(other_names_, name) == other_names_.end())
    other_names_.push_back(name);
}

void JointBuffer::set_part(Rotation& rotation, std::size_t part, std::int64_t stamp,
                           std::string_view source, double value) {
  if (rotation.stamp != stamp || rotation.source != source) rotation.known.fill(false);
  rotation.stamp = stamp;
  rotation.source = source;
  rotation.known[part] = true;
  rotation.xyzw[static_cast<Eigen::Index>(part)] = value;
}

std::size_t JointBuffer::take_rotations(std::int64_t stamp, std::string_view source) {
  std::size_t refused = 0;
  for (Rotation& rotation : rotations_) {
    const auto& known = rotation.known;
    if (!std::all_of(known.begin(), known.end(), [](bool part) { return part; })) continue;
    rotation.known.fill(false);
    const Eigen::Quaterniond q(rotation.xyzw);
    if (std::abs(q.norm() - 1.0) <= kUnitTolerance)
      rotation.track.put({stamp, q.normalized()}, source);
    else
      refused += known.size();
  }
  return refused;
}

void JointBuffer::prune() {
  const std::int64_t limit = stamp_after(*newest_, -history_);
  for (Track& track : tracks_) track.prune(limit, max_states_);
  for (Rotation& rotation : rotations_) rotation.track.prune(limit, max_states_);
}

void JointBuffer::at(std::int64_t stamp, JointAnswer& answer) const {
  answer.gaps.clear();
  answer.disputes.clear();
  answer.age = 0;
  answer.stamp = stamp;
  answer.other_names.clear();
  answer.positions.resize(tracks_.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (rotation_of_[i] || interpolate(i, stamp, answer)) continue;
    answer.gaps.push_back(gap_of(tracks_[i], rules_[i], stamp));
    answer.gaps.back().variable = i;
  }
  for (const Rotation& rotation : rotations_) {
    if (interpolate(rotation, stamp, answer)) continue;
    for (std::size_t i = rotation.first; i < rotation.first + 4; ++i) {
      answer.gaps.push_back(gap_of(rotation.track, RotationRule(), stamp));
      answer.gaps.back().variable = i;
    }
  }
  add_disputes(stamp, answer);
  answer.status = answer.disputes.empty() ? JointStatus::ok : JointStatus::disputed;
  if (!answer.gaps.empty()) answer.status = JointStatus::stale;
  for (JointGap& gap : answer.gaps) {
    if (gap.why != JointStatus::missing) continue;
    answer.status = JointStatus::missing;
    answer.other_names = other_names_;
    gap.is_refused = is_refused_[gap.variable];
  }
}

bool JointBuffer::interpolate(std::size_t variable, std::int64_t stamp, JointAnswer& answer) const {
  const auto around = tracks_[variable].around(stamp);
  if (!around) return false;
  const auto &a = *around.before, &b = *around.after;
  answer.positions[variable] = a.value;
  if (a.stamp == stamp) return true;
  const JointRule& rule = rules_[variable];
  const double seconds = 1e-9 * static_cast<double>(around.gap());
  if (rule.distance(a.value, b.value) > rule.largest_step(seconds)) return false;
  answer.positions[variable] = tracks_[variable].interpolate(around, stamp);
  answer.age = std::max({answer.age, stamp - a.stamp, b.stamp - stamp});
  return true;
}

bool JointBuffer::interpolate(const Rotation& rotation, std::int64_t stamp,
                              JointAnswer& answer) const {
  const auto around = rotation.track.around(stamp);
  if (!around) return false;
  const auto &a = *around.before, &b = *around.after;
  if (RotationRule().distance(a.value, b.value) > JointRule::max_turn) return false;
  Eigen::Map<Eigen::Vector4d>(&answer.positions[rotation.first]) =
      rotation.track.interpolate(around, stamp).coeffs();
  answer.age = std::max({answer.age, stamp - a.stamp, b.stamp - stamp});
  return true;
}

template <typename AnyTrack, typename Rule>
JointGap JointBuffer::gap_of(const AnyTrack& track, const Rule& rule, std::int64_t stamp) const {
  JointGap gap;
  if (!track.newest()) return gap;
  gap.why = JointStatus::stale;
  if (const auto around = track.around(stamp))
    gap.jump = rule.distance(around.before->value, around.after->value);
  const auto* const believed = track.believed_at(stamp);
  if (believed == nullptr) return gap;
  const auto before = believed->track.up_to(stamp);
  const auto all = believed->track.states();
  if (!before.empty()) gap.last_seen = before.back().stamp;
  if (before.size() < all.size()) gap.next_seen = all[before.size()].stamp;
  if (track.has_several_sources()) gap.source = *believed->name;
  return gap;
}

template <typename Found>
JointDispute JointBuffer::dispute_of(const Found& found) const {
  JointDispute dispute;
  dispute.stamp = found.stamp;
  dispute.sources = {*found.value.sources[0], *found.value.sources[1]};
  return dispute;
}

void JointBuffer::add_disputes(std::int64_t stamp, JointAnswer& answer) const {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const auto* const found = tracks_[i].disagreement_near(stamp);
    if (found == nullptr) continue;
    JointDispute& dispute = answer.disputes.emplace_back(dispute_of(*found));
    dispute.variable = i;
    dispute.values = found->value.values;
  }
  for (const Rotation& rotation : rotations_) {
    const auto* const found = rotation.track.disagreement_near(stamp);
    if (found == nullptr) continue;
    const Eigen::Vector4d a = found->value.values[0].coeffs();
    Eigen::Vector4d b = found->value.values[1].coeffs();
    if (a.dot(b) < 0.0) b = -b;  // the same rotation
    Eigen::Index part = 0;       // the one that shows it best
    (a - b).cwiseAbs().maxCoeff(&part);
    JointDispute& dispute = answer.disputes.emplace_back(dispute_of(*found));
    dispute.variable = rotation.first + static_cast<std::size_t>(part);
    dispute.values = {a[part], b[part]};
  }
}

std::optional<std::int64_t> JointBuffer::complete_until() const {
  if (tracks_.empty()) return std::nullopt;
  std::int64_t until = std::numeric_limits<std::int64_t>::max();
  const auto know = [&until](const auto& track) {
    until = std::min(until, track.newest().value_or(until));
    return track.newest().has_value();
  };
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (!rotation_of_[i] && !know(tracks_[i])) return std::nullopt;
  for (const Rotation& rotation : rotations_)
    if (!know(rotation.track)) return std::nullopt;
  return until;
}

std::optional<std::int64_t> JointBuffer::newest_of(std::span<const std::string> names) const {
  std::optional<std::int64_t> newest;
  for (const std::string& name : names) {
    const auto at = index_.find(name);
    if (at == index_.end()) continue;
    const auto note = [&newest](const auto& track) {
      if (const auto last = track.newest()) newest = std::max(newest.value_or(*last), *last);
    };
    if (const auto rotation = rotation_of_[at->second])
      note(rotations_[*rotation].track);
    else
      note(tracks_[at->second]);
  }
  return newest;
}

void JointBuffer::clear() {
  for (Track& track : tracks_) track.clear();
  for (Rotation& rotation : rotations_) {
    rotation.track.clear();
    rotation.known.fill(false);
  }
  newest_.reset();
}

}  // namespace penumbra
