// SPDX-License-Identifier: Apache-2.0
// With X = [v]x and angle a = |v|, X^3 = -a^2 X, all series end at X^2. Each coefficient is an
// alternating series of a^2, taken as such where its closed form would cancel.
#include <cmath>

#include <penumbra/tracking/rotation_vector-inl.hpp>

namespace penumbra::detail {
namespace {

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

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector) {
  const double half = vector.norm() / 2;
  const double scale = half == 0 ? 0.5 : std::sin(half) / half / 2;
  return {std::cos(half), scale * vector.x(), scale * vector.y(), scale * vector.z()};
}

Eigen::Vector3d vector_of(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& vector) {
  const Eigen::Matrix3d x = cross_matrix(vector);
  const double a = vector.norm();
  return Eigen::Matrix3d::Identity() + square_term(a) * x + cubic_term(a) * x * x;
}

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

}  // namespace penumbra::detail
