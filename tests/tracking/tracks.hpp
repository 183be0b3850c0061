// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::test {

/// A stamp as clocks of robots have them, so that small differences of large numbers count.
inline constexpr std::int64_t epoch = 1'700'000'000'000'000'000;

inline std::int64_t stamp_at(double seconds) { return epoch + std::llround(seconds * 1e9); }

inline Eigen::Matrix3d turn(const Eigen::Vector3d& vector) {
  if (vector.norm() == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix();
}

inline Eigen::Vector3d turn_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

inline Eigen::Isometry3d pose_of(const Eigen::Vector3d& position, const Eigen::Matrix3d& rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() = rotation;
  return pose;
}

/// A pose that moves with constant velocities, exactly.
struct Twisting {
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d turning = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Isometry3d at(double seconds) const {
    return pose_of(start.translation() + seconds * velocity,
                   turn(seconds * turning) * start.linear());
  }
};

/// What has to be done to a pose to reach another, as PoseEstimate::covariance counts it.
inline Vector6d difference(const Eigen::Isometry3d& to, const Eigen::Isometry3d& from) {
  Vector6d d;
  d << to.translation() - from.translation(), turn_vector(to.linear() * from.linear().transpose());
  return d;
}

inline Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vector6d& by) {
  Eigen::Isometry3d result = pose;
  result.translation() += by.head<3>();
  result.linear() = turn(by.tail<3>()) * pose.linear();
  return result;
}

template <int n>
Eigen::Matrix<double, n, 1> normal(std::mt19937_64& random) {
  std::normal_distribution<double> unit;
  Eigen::Matrix<double, n, 1> x;
  for (int i = 0; i < n; ++i) x[i] = unit(random);
  return x;
}

inline Vector6d sigmas(double position, double orientation) {
  Vector6d s;
  s << Eigen::Vector3d::Constant(position), Eigen::Vector3d::Constant(orientation);
  return s;
}

inline Eigen::Isometry3d random_pose(std::mt19937_64& random) {
  const Eigen::Vector3d position = normal<3>(random);
  return pose_of(position, turn(normal<3>(random)));
}

}  // namespace penumbra::test
