// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include <Eigen/LU>

#include <penumbra/base/error.hpp>
#include <penumbra/tracking/gaussian.hpp>
#include <penumbra/tracking/pose_filter-inl.hpp>
#include <penumbra/tracking/track_history-inl.hpp>
#include <penumbra/tracking/trackers.hpp>

namespace penumbra {
namespace {

using detail::PoseFilter;

constexpr double weight_power = 5.0;  // of the share that was seen
constexpr double least_seen = 0.4;    // accepting less makes no error smaller (research/README.md)

void check_direction(const PoseTrackerConfig& config) {
  std::ostringstream message;
  const Eigen::Vector3d& d = config.direction;
  const bool constrained = config.motion == Motion::along_direction;
  const bool given = !(d.array() == 0).all();
  if (constrained && (!d.allFinite() || !(d.norm() > detail::positive.least))) {
    message << "direction is (" << d.x() << ", " << d.y() << ", " << d.z()
            << "); motion along_direction needs one that is finite and not zero";
  } else if (!constrained && (given || config.speed)) {
    message << (given ? "direction" : "speed")
            << " is given; it is for motion along_direction only";
  } else {
    return;
  }
  throw InputError(message.str());
}

Matrix6d default_covariance(const PoseTrackerConfig& config) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(config.position_sigma * config.position_sigma),
      Eigen::Vector3d::Constant(config.orientation_sigma * config.orientation_sigma);
  return variances.asDiagonal();
}

/// A matrix's rotation, where it is one up to rounding and the digits of a text file.
std::optional<Eigen::Quaterniond> nearest_rotation(const Eigen::Matrix3d& matrix) {
  constexpr double digits = 1e-4;
  if (!matrix.allFinite() || !(matrix.determinant() > 0)) return std::nullopt;
  const Eigen::Matrix3d product = matrix.transpose() * matrix;
  if (!((product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= digits)) {
    return std::nullopt;
  }
  // Newton's iteration to the polar factor (Higham 1986): its error is squared each time.
  Eigen::Matrix3d rotation = matrix;
  for (int i = 0; i < 2; ++i) {
    rotation *= (3 * Eigen::Matrix3d::Identity() - rotation.transpose() * rotation) / 2;
  }
  return Eigen::Quaterniond(rotation).normalized();
}

}  // namespace

void PoseTrackerConfig::check() const {
  check_settings(*this);
  check_direction(*this);
}

struct PoseTracker::State {
  explicit State(const PoseTrackerConfig& given)
      : config(given), covariance(default_covariance(given)), history(PoseFilter(given), given) {}

  PoseTrackerConfig config;
  Matrix6d covariance;  // of an estimate without one
  detail::TrackHistory<PoseFilter, PoseTrackerConfig> history;
};

PoseTracker::PoseTracker(const PoseTrackerConfig& config) {
  config.check();
  state_ = std::make_unique<State>(config);
}
PoseTracker::~PoseTracker() = default;
PoseTracker::PoseTracker(PoseTracker&&) noexcept = default;
PoseTracker& PoseTracker::operator=(PoseTracker&&) noexcept = default;

Outcome PoseTracker::update(const PoseEstimate& estimate, Verdict verdict) {
  const Eigen::Vector3d position = estimate.pose.translation();
  const auto orientation = nearest_rotation(estimate.pose.linear());
  const Matrix6d covariance = estimate.covariance.value_or(state_->covariance);
  const double seen = estimate.seen.value_or(1.0);
  if (!position.allFinite() || !orientation || !detail::is_covariance(covariance) ||
      !(seen >= 0.0 && seen <= 1.0)) {
    return Outcome::refused_invalid;
  }
  const bool is_part_enough = estimate.seen && seen >= least_seen;
  const Verdict worst =
      state_->config.worst.value_or(is_part_enough ? Verdict::partial : Verdict::visible);
  if (!detail::good_enough(verdict, worst)) return Outcome::refused_verdict;
  const double weight = std::pow(std::max(seen, least_seen), weight_power);
  return state_->history.take(estimate.stamp, {position, *orientation, covariance, weight});
}

TrackedPose PoseTracker::at(std::int64_t stamp) const {
  const auto recall = state_->history.at(stamp);
  if (!recall) return {};
  TrackedPose pose;
  pose.source = detail::source_of(*recall, state_->config.motion == Motion::still);
  pose.age = recall->age;
  pose.pose.translation() = recall->state.position;
  pose.pose.linear() = recall->state.orientation.toRotationMatrix();
  pose.twist = recall->state.twist;
  pose.covariance = detail::symmetric(recall->state.covariance.topLeftCorner<6, 6>());
  return pose;
}

void PoseTracker::reset() { state_->history.reset(); }

}  // namespace penumbra
