// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracks.hpp"

#include <random>
#include <vector>

namespace penumbra::test {

/// A target that moves as a tracker's configuration says: a sample of its stochastic model,
/// simulated in small steps of the true, curved motion.
class RandomMotion {
 public:
  RandomMotion(const PoseTrackerConfig& config, std::mt19937_64& random)
      : config_(config), random_(random), pose_(random_pose(random)) {
    const Eigen::Vector3d linear = config.speed_sigma * normal<3>(random);
    const Eigen::Vector3d angular = config.angular_speed_sigma * normal<3>(random);
    twist_ << along(linear), (config.motion == Motion::constant_twist ? 1.0 : 0.0) * angular;
    if (config.speed) twist_.head<3>() = *config.speed * config.direction.normalized();
  }

  void advance(double seconds) {
    constexpr int steps = 20;
    for (int i = 0; i < steps; ++i) step(seconds / steps);
  }

  [[nodiscard]] const Eigen::Isometry3d& pose() const { return pose_; }

  /// An estimate of it, with noise of the configuration's sigmas.
  [[nodiscard]] PoseEstimate estimate(double seconds) const {
    const Vector6d noise = sigmas(config_.position_sigma, config_.orientation_sigma);
    return {stamp_at(seconds), moved(pose_, noise.cwiseProduct(normal<6>(random_)))};
  }

 private:
  /// What of a vector changes a velocity; the rest makes positions drift.
  [[nodiscard]] Eigen::Vector3d along(const Eigen::Vector3d& v) const {
    if (config_.motion == Motion::still || config_.speed) return Eigen::Vector3d::Zero();
    if (config_.motion != Motion::along_direction) return v;
    const Eigen::Vector3d d = config_.direction.normalized();
    return d * d.dot(v);
  }

  void step(double h) {
    const Eigen::Vector3d kick = normal<3>(random_), wander = normal<3>(random_);
    const Vector6d before = twist_;
    twist_.head<3>() += config_.acceleration * std::sqrt(h) * along(kick);
    Vector6d change = Vector6d::Zero();
    change.head<3>() = config_.drift * std::sqrt(h) * (wander - along(wander));
    if (config_.motion == Motion::constant_twist) {
      twist_.tail<3>() += config_.angular_acceleration * std::sqrt(h) * normal<3>(random_);
    } else {
      change.tail<3>() = config_.angular_drift * std::sqrt(h) * normal<3>(random_);
    }
    pose_ = moved(pose_, change + h / 2 * (before + twist_));
  }

  PoseTrackerConfig config_;
  std::mt19937_64& random_;
  Eigen::Isometry3d pose_;
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
