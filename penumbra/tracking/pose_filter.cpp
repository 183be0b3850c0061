// SPDX-License-Identifier: Apache-2.0
// Position and velocity: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and
// Navigation" (2001), section 6.2.2, continuous white noise acceleration. Orientation: the same on
// SO(3), errors in the fixed frame, with Sola, Deray, Atchuthan (arXiv 1812.01537); its noise is
// integrated exactly for constant angular velocity (angular_noise). After a correction the error is
// counted from the new estimate, which turns its covariance by the left Jacobian (Sola,
// "Quaternion kinematics for the error-state Kalman filter", arXiv 1711.02508, section 6.3).
#include <penumbra/tracking/gaussian-inl.hpp>
#include <penumbra/tracking/pose_filter-inl.hpp>
#include <penumbra/tracking/rotation_vector-inl.hpp>

namespace penumbra::detail {
namespace {

double squared(double x) { return x * x; }

/// A measured pose as the filter sees it.
struct Innovation {
  Vector6d residual;  // what has to be added to the state to reach it
  Matrix6d noise;     // of that
};

/// With the measured rotation Exp(r) R, and the true one Exp(n) Exp(r) R = Exp(d) R for noise n and
/// error d, n = J(-r)^-1 d - r to first order in d, so d = r + J(-r) n: r is its own image.
Innovation innovation_of(const PoseFilter::State& state, const PoseFilter::Measurement& measured) {
  Innovation innovation;
  auto& residual = innovation.residual;
  residual.head<3>() = measured.position - state.position;
  residual.tail<3>() = vector_of(measured.orientation * state.orientation.conjugate());
  const Eigen::Matrix3d jacobian = left_jacobian(-residual.tail<3>());
  auto& noise = innovation.noise;
  noise = measured.covariance;
  noise.bottomRows<3>() = (jacobian * noise.bottomRows<3>()).eval();
  noise.rightCols<3>() = (noise.rightCols<3>() * jacobian.transpose()).eval();
  return innovation;
}

}  // namespace

PoseFilter::PoseFilter(const PoseTrackerConfig& config) {
  const Eigen::Matrix3d all = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d free = Eigen::Matrix3d::Zero();  // directions in which velocity may change
  if (config.motion == Motion::constant_twist || config.motion == Motion::constant_velocity) {
    free = all;
  } else if (config.motion == Motion::along_direction) {
    const Eigen::Vector3d direction = config.direction.normalized();
    if (config.speed) {
      velocity_ = *config.speed * direction;
    } else {
      free = direction * direction.transpose();
    }
  }
  velocity_variance_ = squared(config.speed_sigma) * free;
  acceleration_ = squared(config.acceleration) * free;
  drift_ = squared(config.drift) * (all - free);
  if (config.motion == Motion::constant_twist) {
    turn_variance_ = squared(config.angular_speed_sigma);
    angular_acceleration_ = squared(config.angular_acceleration);
  } else {
    angular_drift_ = squared(config.angular_drift);
  }
}

PoseFilter::State PoseFilter::begin(const Measurement& measurement) const {
  State state;
  state.position = measurement.position;
  state.orientation = measurement.orientation;
  state.twist.head<3>() = velocity_;
  state.covariance.topLeftCorner<6, 6>() = measurement.covariance / measurement.weight;
  state.covariance.block<3, 3>(6, 6) = velocity_variance_;
  state.covariance.block<3, 3>(9, 9).diagonal().setConstant(turn_variance_);
  return state;
}

PoseFilter::State PoseFilter::predicted(const State& state, double seconds) const {
  const Eigen::Vector3d turning = state.twist.tail<3>();
  const Eigen::Vector3d turn = seconds * turning;
  const Eigen::Quaterniond rotation = rotation_of(turn);
  State later = state;
  later.position += seconds * state.twist.head<3>();
  later.orientation = (rotation * state.orientation).normalized();

  const Eigen::Matrix3d turned = rotation.toRotationMatrix();
  const Eigen::Matrix3d spread = seconds * left_jacobian(turn);
  auto& p = later.covariance;
  p.topRows<3>() += seconds * p.middleRows<3>(6);
  p.middleRows<3>(3) = (turned * p.middleRows<3>(3) + spread * p.bottomRows<3>()).eval();
  p.leftCols<3>() += seconds * p.middleCols<3>(6);
  p.middleCols<3>(3) =
      (p.middleCols<3>(3) * turned.transpose() + p.rightCols<3>() * spread.transpose()).eval();
  add_noise(p, turning, seconds);
  return later;
}

void PoseFilter::add_noise(Matrix12d& covariance, const Eigen::Vector3d& turning,
                           double seconds) const {
  const double t = seconds;
  covariance.block<3, 3>(0, 0) += t * t * t / 3 * acceleration_ + t * drift_;
  covariance.block<3, 3>(0, 6) += t * t / 2 * acceleration_;
  covariance.block<3, 3>(6, 0) += t * t / 2 * acceleration_;
  covariance.block<3, 3>(6, 6) += t * acceleration_;
  covariance.block<3, 3>(3, 3).diagonal().array() += t * angular_drift_;
  if (angular_acceleration_ == 0) return;
  const AngularNoise noise = angular_noise(turning, t);
  covariance.block<3, 3>(3, 3) += angular_acceleration_ * noise.angle;
  covariance.block<3, 3>(3, 9) += angular_acceleration_ * noise.mixed;
  covariance.block<3, 3>(9, 3) += angular_acceleration_ * noise.mixed.transpose();
  covariance.block<3, 3>(9, 9).diagonal().array() += angular_acceleration_ * t;
}

double PoseFilter::distance(const State& state, const Measurement& measurement) const {
  const Innovation innovation = innovation_of(state, measurement);
  const Matrix6d total = state.covariance.topLeftCorner<6, 6>() + innovation.noise;
  return squared_distance<6>(total, innovation.residual) / measurement.weight;
}

void PoseFilter::correct(State& state, const Measurement& measurement) const {
  const Innovation innovation = innovation_of(state, measurement);
  const Matrix6d noise = innovation.noise / measurement.weight;
  const Eigen::Matrix<double, 12, 1> change =
      kalman_correction<12, 6>(state.covariance, noise, innovation.residual);
  const Eigen::Vector3d turn = change.segment<3>(3);
  state.position += change.head<3>();
  state.orientation = (rotation_of(turn) * state.orientation).normalized();
  state.twist += change.tail<6>();
  const Eigen::Matrix3d jacobian = left_jacobian(turn);
  auto& p = state.covariance;
  p.middleRows<3>(3) = (jacobian * p.middleRows<3>(3)).eval();
  p.middleCols<3>(3) = (p.middleCols<3>(3) * jacobian.transpose()).eval();
}

}  // namespace penumbra::detail
