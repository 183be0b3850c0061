// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include <penumbra/base/error.hpp>
#include <penumbra/targets/target_track.hpp>

namespace penumbra {
namespace {

Eigen::Vector3d position_of(const TargetEstimate& estimate) {
  if (const auto* point = std::get_if<Eigen::Vector3d>(&estimate.value)) return *point;
  return std::get<Eigen::Isometry3d>(estimate.value).translation();
}

Matrix6d rotated(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
  Matrix6d both = Matrix6d::Zero();
  both.topLeftCorner<3, 3>() = R;
  both.bottomRightCorner<3, 3>() = R;
  return both * covariance * both.transpose();
}

/// Returns sigma along the most uncertain direction, metres.
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

TargetTrack::TargetTrack(const TargetHandling& handling) {
  bool stays = false;
  if (const auto* pose = std::get_if<PoseTrackerConfig>(&handling)) {
    tracker_.emplace<PoseTracker>(*pose);
    stays = pose->motion == Motion::still;
  } else if (const auto* point = std::get_if<PointTrackerConfig>(&handling)) {
    tracker_.emplace<PointTracker>(*point);
    stays = point->motion == PointMotion::hold;
  }
  if (stays) unmeasured_ = Source::held;
}

const RecentVerdict* TargetTrack::reliable_verdict(std::int64_t stamp) {
  const RecentVerdict* const verdict = verdicts_.find(stamp);
  return verdict != nullptr && verdict->is_reliable ? verdict : nullptr;
}

Outcome TargetTrack::update(std::int64_t stamp, const TargetEstimate& estimate,
                            const RecentVerdict& verdict, const Eigen::Isometry3d& T_root_frame) {
  check_estimate(estimate);
  std::optional<Matrix6d> covariance;
  if (estimate.covariance) covariance = rotated(*estimate.covariance, T_root_frame.linear());
  if (auto* points = std::get_if<PointTracker>(&tracker_)) {
    PointEstimate point{stamp, T_root_frame * position_of(estimate), {}};
    if (covariance) point.covariance = covariance->topLeftCorner<3, 3>();
    return points->update(point, verdict.verdict);
  }
  const auto* pose = std::get_if<Eigen::Isometry3d>(&estimate.value);
  if (pose == nullptr) return Outcome::refused_invalid;
  return std::get<PoseTracker>(tracker_).update(
      {stamp, T_root_frame * *pose, covariance, std::min(verdict.seen, 1.0)}, verdict.verdict);
}

HandledTarget TargetTrack::carry(std::int64_t stamp, const Eigen::Isometry3d& T_root_target) {
  if (auto* poses = std::get_if<PoseTracker>(&tracker_)) {
    poses->reset();
    poses->update({.stamp = stamp, .pose = T_root_target}, Verdict::visible);
  } else {
    auto& points = std::get<PointTracker>(tracker_);
    points.reset();
    points.update({.stamp = stamp, .position = T_root_target.translation()}, Verdict::visible);
  }
  HandledTarget handled = at(stamp, false);
  if (handled.source != Source::lost) handled.source = Source::predicted;
  return handled;
}

HandledTarget TargetTrack::at(std::int64_t stamp, bool is_measured) const {
  const auto* const poses = std::get_if<PoseTracker>(&tracker_);
  HandledTarget handled = poses != nullptr
                              ? handled_pose(poses->at(stamp))
                              : handled_point(std::get<PointTracker>(tracker_).at(stamp));
  if (!is_measured && handled.source == Source::measured) handled.source = unmeasured_;
  return handled;
}

}  // namespace penumbra
