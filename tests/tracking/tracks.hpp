// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::test {

/// A stamp as clocks of robots have them, so that small differences of large numbers count.
inline constexpr std::int64_t epoch = 1'700'000'000'000'000'000;

inline std::int64_t stamp_at(double seconds) { return epoch + std::llround(seconds * 1e9); }

inline PoseEstimate seen_at(double seconds, double x) {
  return {.stamp = stamp_at(seconds), .pose = at(x, 0, 0)};
}

inline Matrix3d turn(const Vector3d& vector) {
  if (vector.norm() == 0) return Matrix3d::Identity();
  return AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix();
}

inline Vector3d turn_vector(const Matrix3d& rotation) {
  const AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

inline Isometry3d pose_of(const Vector3d& position, const Matrix3d& rotation) {
  Isometry3d pose = at(position);
  pose.linear() = rotation;
  return pose;
}

/// A pose that moves with constant velocities, exactly.
struct Twisting {
  Isometry3d start = Isometry3d::Identity();
  Vector3d velocity = Vector3d::Zero();
  Vector3d turning = Vector3d::Zero();

  [[nodiscard]] Isometry3d at(double seconds) const {
    return pose_of(start.translation() + seconds * velocity,
                   turn(seconds * turning) * start.linear());
  }
};

/// What has to be done to a pose to reach another, as PoseEstimate::covariance counts it.
inline Vector6d difference(const Isometry3d& to, const Isometry3d& from) {
  Vector6d d;
  d << to.translation() - from.translation(), turn_vector(to.linear() * from.linear().transpose());
  return d;
}

inline Isometry3d moved(const Isometry3d& pose, const Vector6d& by) {
  Isometry3d result = pose;
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
  s << Vector3d::Constant(position), Vector3d::Constant(orientation);
  return s;
}

inline Isometry3d random_pose(std::mt19937_64& random) {
  const Vector3d position = normal<3>(random);
  return pose_of(position, turn(normal<3>(random)));
}

/// What of a vector changes a velocity; the rest makes positions drift.
inline Vector3d along(const PoseTrackerConfig& config, const Vector3d& v) {
  if (config.motion == Motion::still || config.speed) return Vector3d::Zero();
  if (config.motion != Motion::along_direction) return v;
  const Vector3d d = config.direction.normalized();
  return d * d.dot(v);
}

/// A target that moves as a tracker's configuration says: a sample of its stochastic model,
/// simulated in small steps of the true, curved motion.
class RandomMotion {
 public:
  RandomMotion(const PoseTrackerConfig& config, std::mt19937_64& random)
      : config_(config), random_(random), pose_(random_pose(random)) {
    const Vector3d linear = config.speed_sigma * normal<3>(random);
    const Vector3d angular = config.angular_speed_sigma * normal<3>(random);
    twist_ << along(config, linear),
        (config.motion == Motion::constant_twist ? 1.0 : 0.0) * angular;
    if (config.speed) twist_.head<3>() = *config.speed * config.direction.normalized();
  }

  void advance(double seconds) {
    constexpr int steps = 20;
    for (int i = 0; i < steps; ++i) step(seconds / steps);
  }

  [[nodiscard]] const Isometry3d& pose() const { return pose_; }

  /// An estimate of it, with noise of the configuration's sigmas.
  [[nodiscard]] PoseEstimate estimate(double seconds) const {
    const Vector6d noise = sigmas(config_.position_sigma, config_.orientation_sigma);
    return {stamp_at(seconds), moved(pose_, noise.cwiseProduct(normal<6>(random_)))};
  }

 private:
  void step(double h) {
    const Vector3d kick = normal<3>(random_), wander = normal<3>(random_);
    const Vector6d before = twist_;
    twist_.head<3>() += config_.acceleration * std::sqrt(h) * along(config_, kick);
    Vector6d change = Vector6d::Zero();
    change.head<3>() = config_.drift * std::sqrt(h) * (wander - along(config_, wander));
    if (config_.motion == Motion::constant_twist) {
      twist_.tail<3>() += config_.angular_acceleration * std::sqrt(h) * normal<3>(random_);
    } else {
      change.tail<3>() = config_.angular_drift * std::sqrt(h) * normal<3>(random_);
    }
    pose_ = moved(pose_, change + h / 2 * (before + twist_));
  }

  PoseTrackerConfig config_;
  std::mt19937_64& random_;
  Isometry3d pose_;
  Vector6d twist_ = Vector6d::Zero();
};

/// One configuration of each motion.
inline std::vector<PoseTrackerConfig> all_motions() {
  std::vector<PoseTrackerConfig> all(5);
  all[1].motion = Motion::constant_velocity;
  all[2].motion = Motion::along_direction;
  all[2].direction = {1, 2, -1};
  all[2].acceleration = 0.05;
  all[3] = all[2];
  all[3].speed = 0.2;
  all[4].motion = Motion::still;
  return all;
}

}  // namespace penumbra::test
