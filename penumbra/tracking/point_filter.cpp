// SPDX-License-Identifier: Apache-2.0
#include <penumbra/tracking/gaussian-inl.hpp>
#include <penumbra/tracking/point_filter-inl.hpp>

namespace penumbra::detail {

PointFilter::PointFilter(const PointTrackerConfig& config)
    : hold_(config.motion == PointMotion::hold),
      density_(hold_ ? 0.0 : config.acceleration * config.acceleration),
      variance_(hold_ ? config.held_speed * config.held_speed
                      : config.speed_sigma * config.speed_sigma) {}

PointFilter::State PointFilter::begin(const Measurement& measurement) const {
  State state;
  state.position = measurement.position;
  state.covariance.topLeftCorner<3, 3>() = measurement.covariance;
  state.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(variance_);
  return state;
}

PointFilter::State PointFilter::predicted(const State& state, double seconds) const {
  const double t = seconds;
  State later = state;
  later.position += t * state.velocity;
  auto& p = later.covariance;
  p.topRows<3>() += t * p.bottomRows<3>();
  p.leftCols<3>() += t * p.rightCols<3>();
  p.topLeftCorner<3, 3>().diagonal().array() += density_ * t * t * t / 3;
  p.topRightCorner<3, 3>().diagonal().array() += density_ * t * t / 2;
  p.bottomLeftCorner<3, 3>().diagonal().array() += density_ * t * t / 2;
  p.bottomRightCorner<3, 3>().diagonal().array() += density_ * t;
  return later;
}

double PointFilter::distance(const State& state, const Measurement& measurement) const {
  const Eigen::Matrix3d total = state.covariance.topLeftCorner<3, 3>() + measurement.covariance;
  const Eigen::Vector3d residual = measurement.position - state.position;
  return squared_distance<3>(total, residual);
}

void PointFilter::correct(State& state, const Measurement& measurement) const {
  if (hold_) {
    state = begin(measurement);
    return;
  }
  const Eigen::Vector3d residual = measurement.position - state.position;
  const Eigen::Matrix<double, 6, 1> change =
      kalman_correction<6, 3>(state.covariance, measurement.covariance, residual);
  state.position += change.head<3>();
  state.velocity += change.tail<3>();
}

}  // namespace penumbra::detail
