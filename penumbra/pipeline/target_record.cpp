// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/target_record-inl.hpp>

namespace penumbra {
namespace {

Eigen::Vector3d position_of(const TargetEstimate& estimate) {
  if (const auto* point = std::get_if<Eigen::Vector3d>(&estimate.value)) return *point;
  return std::get<Eigen::Isometry3d>(estimate.value).translation();
}

Matrix6d turned(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = R;
  both.bottomRightCorner<3, 3>() = R;
  return both * covariance * both.transpose();
}

/// Of the direction in which the position is least known, metres.
double largest_sigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().z()));
}

HandledTarget handled_pose(const TrackedPose& tracked) {
  HandledTarget handled{
      tracked.source, tracked.age, {}, {}, largest_sigma(tracked.covariance.topLeftCorner<3, 3>())};
  if (tracked.source == Source::lost) return handled;
  handled.position = tracked.pose.translation();
  handled.orientation = Eigen::Quaterniond(tracked.pose.linear());
  return handled;
}

HandledTarget handled_point(const TrackedPoint& tracked) {
  HandledTarget handled{tracked.source, tracked.age, {}, {}, largest_sigma(tracked.covariance)};
  if (tracked.source != Source::lost) handled.position = tracked.position;
  return handled;
}

}  // namespace

void VerdictLog::add(const StampedVerdict& verdict) {
  entries_.reserve(verdicts);
  const auto same =
      std::find_if(entries_.begin(), entries_.end(),
                   [&](const StampedVerdict& known) { return known.stamp == verdict.stamp; });
  if (same != entries_.end()) {
    *same = verdict;
  } else if (entries_.size() < verdicts) {
    entries_.push_back(verdict);
  } else {
    entries_[next_] = verdict;
    next_ = (next_ + 1) % verdicts;
  }
}

std::optional<StampedVerdict> VerdictLog::find(std::int64_t stamp) const {
  for (const StampedVerdict& known : entries_)
    if (known.stamp == stamp) return known;
  return std::nullopt;
}

TargetTrack::TargetTrack(const TargetHandling& handling) {
  bool stays = false;
  if (const auto* pose = std::get_if<PoseTrackerConfig>(&handling)) {
    tracker_.emplace<PoseTracker>(*pose);
    stays = pose->motion == Motion::still;
  } else if (const auto* point = std::get_if<PointTrackerConfig>(&handling)) {
    tracker_.emplace<PointTracker>(*point);
    stays = point->motion == PointMotion::hold;
  }
  if (stays) carried_ = Source::held;
}

Outcome TargetTrack::update(const TargetEstimate& estimate, const StampedVerdict& verdict,
                            const Eigen::Isometry3d& T_root_frame) {
  try {
    check_estimate(estimate);
  } catch (const InputError&) {
    return Outcome::refused_invalid;
  }
  std::optional<Matrix6d> covariance;
  if (estimate.covariance) covariance = turned(*estimate.covariance, T_root_frame.linear());
  if (auto* points = std::get_if<PointTracker>(&tracker_)) {
    PointEstimate point{verdict.stamp, T_root_frame * position_of(estimate), {}};
    if (covariance) point.covariance = covariance->topLeftCorner<3, 3>();
    return points->update(point, verdict.verdict);
  }
  const auto* pose = std::get_if<Eigen::Isometry3d>(&estimate.value);
  if (pose == nullptr) return Outcome::refused_invalid;
  return std::get<PoseTracker>(tracker_).update(
      {verdict.stamp, T_root_frame * *pose, covariance, std::min(verdict.seen, 1.0)},
      verdict.verdict);
}

std::optional<HandledTarget> TargetTrack::at(std::int64_t stamp, bool is_measured) const {
  std::optional<HandledTarget> handled;
  if (const auto* poses = std::get_if<PoseTracker>(&tracker_))
    handled = handled_pose(poses->at(stamp));
  else if (const auto* points = std::get_if<PointTracker>(&tracker_))
    handled = handled_point(points->at(stamp));
  if (handled && !is_measured && handled->source == Source::measured) handled->source = carried_;
  return handled;
}

}  // namespace penumbra
