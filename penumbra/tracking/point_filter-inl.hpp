// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <penumbra/tracking/point_tracker.hpp>

namespace penumbra::detail {

/// A Kalman filter of position and velocity under white acceleration (Bar-Shalom, Li, Kirubarajan
/// 2001, section 6.2.2, "continuous white noise acceleration"). A point that is held has a constant
/// velocity that nobody knows, of mean 0: each accepted position begins anew.
class PointFilter {
 public:
  struct State {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  };
  struct Measurement {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };

  explicit PointFilter(const PointTrackerConfig& config);

  [[nodiscard]] State begin(const Measurement& measurement) const;
  [[nodiscard]] State predicted(const State& state, double seconds) const;
  [[nodiscard]] double distance(const State& state, const Measurement& measurement) const;
  void correct(State& state, const Measurement& measurement) const;

 private:
  bool hold_;
  double density_;   // of white acceleration, squared
  double variance_;  // of an unknown velocity
};

}  // namespace penumbra::detail
