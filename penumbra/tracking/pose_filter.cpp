// SPDX-License-Identifier: Apache-2.0
// Position and velocity: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and
// Navigation" (2001), section 6.2.2, continuous white noise acceleration. Orientation: the same on
// SO(3), errors in the fixed frame, with Sola, Deray, Atchuthan (arXiv 1812.01537); its noise is
// integrated exactly for constant angular velocity (angular_noise). After a correction the error is
// counted from the new estimate, which turns its covariance by the left Jacobian (Sola,
// "Quaternion kinematics for the error-state Kalman filter", arXiv 1711.02508, section 6.3).
#include <penumbra/tracking/gaussian.hpp>
#include <penumbra/tracking/pose_filter-inl.hpp>

namespace penumbra::detail {
namespace {

// With X = [v]x and angle a = |v|, X^3 = -a^2 X, all series end at X^2. Each coefficient is an
// alternating series of a^2, evaluated as such for small a, where its closed form would cancel.

constexpr double small_angle = 0.1;  // where the fifth term of a series is below 1e-15 of the first

/// (a - sin a) / a^3.
double cubic_term(double a) {
  const double s = a * a;
  if (a < small_angle) return (1 - s / 20 * (1 - s / 42 * (1 - s / 72))) / 6;
  return (a - std::sin(a)) / (a * s);
}

/// (1 - cos a) / a^2, as 1/2 sin(a/2)^2 / (a/2)^2.
double square_term(double a) {
  const double half = a / 2;
  const double ratio = half == 0 ? 1.0 : std::sin(half) / half;
  return ratio * ratio / 2;
}

/// (1/2 - (1 - cos a) / a^2) / a^2.
double fourth_term(double a) {
  const double s = a * a;
  if (a < small_angle) return (1 - s / 30 * (1 - s / 56 * (1 - s / 90))) / 24;
  return (0.5 - square_term(a)) / s;
}

/// (1/3 - 2 (a - sin a) / a^3) / a^2.
double fifth_term(double a) {
  const double s = a * a;
  if (a < small_angle) return (1 - s / 42 * (1 - s / 72 * (1 - s / 110))) / 60;
  return (1.0 / 3 - 2 * cubic_term(a)) / s;
}

/// Rotation vectors: axis times angle, radians. Notation and formulas: Sola, Deray, Atchuthan, "A
/// micro Lie theory for state estimation in robotics", arXiv 1812.01537 (2018), appendix on SO(3).
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Exp: the rotation of a vector.
Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector) {
  const double half = vector.norm() / 2;
  const double scale = half == 0 ? 0.5 : std::sin(half) / half / 2;
  return {std::cos(half), scale * vector.x(), scale * vector.y(), scale * vector.z()};
}

/// Log: the vector of a rotation, at most pi long.
Eigen::Vector3d vector_of(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The left Jacobian J: Exp(v + d) = Exp(J(v) d) Exp(v) for small d.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& vector) {
  const Eigen::Matrix3d x = cross_matrix(vector);
  const double a = vector.norm();
  return Eigen::Matrix3d::Identity() + square_term(a) * x + cubic_term(a) * x * x;
}

/// Covariance that white angular acceleration of spectral density 1 adds over time to an error
/// (d, e) of orientation and angular velocity w, Exp(d) in the fixed frame: d' = w x d + e, so that
/// an error of s seconds ago counts with Exp(w s) and s J(w s). Exact for constant w.
struct AngularNoise {
  Eigen::Matrix3d angle;  ///< of d: the integral of s^2 J J^T
  Eigen::Matrix3d mixed;  ///< of d with e: the integral of s J; that of e is the time
};

// J J^T is 1 along the axis and 2 (1 - cos a) / a^2 across it, so s^2 J J^T is that of s seconds;
// s J = s I + (1 - cos ws) / w K + (s - sin(ws) / w) K^2 with K of the unit axis.
AngularNoise angular_noise(const Eigen::Vector3d& velocity, double seconds) {
  const Eigen::Matrix3d x = cross_matrix(velocity * seconds);
  const Eigen::Matrix3d xx = x * x;
  const double a = velocity.norm() * seconds;
  const double t2 = seconds * seconds;
  return {t2 * seconds * (Eigen::Matrix3d::Identity() / 3 + fifth_term(a) * xx),
          t2 * (Eigen::Matrix3d::Identity() / 2 + cubic_term(a) * x + fourth_term(a) * xx)};
}

double squared(double x) { return x * x; }

/// A measured pose relative to the state.
struct Innovation {
  Vector6d residual;  // measurement minus state
  Matrix6d noise;     // covariance of the residual
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
  return squared_distance(total, innovation.residual) / measurement.weight;
}

void PoseFilter::correct(State& state, const Measurement& measurement) const {
  const Innovation innovation = innovation_of(state, measurement);
  const Matrix6d noise = innovation.noise / measurement.weight;
  const Eigen::Matrix<double, 12, 1> change =
      kalman_correction(state.covariance, noise, innovation.residual);
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
