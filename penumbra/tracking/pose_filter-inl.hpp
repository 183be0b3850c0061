// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::detail {

/// An error-state Kalman filter on R^3 x SO(3). Errors are vectors in the fixed frame: of position,
/// orientation (true rotation = Exp(error) * estimated), linear and angular velocity. What a motion
/// does not let change has neither noise nor variance, so that one filter serves all motions.
class PoseFilter {
 public:
  using Matrix12d = Eigen::Matrix<double, 12, 12>;
  struct State {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    Vector6d twist = Vector6d::Zero();
    Matrix12d covariance = Matrix12d::Zero();
  };
  struct Measurement {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< as it was given
    double weight = 1.0;                     ///< what it counts, in (0, 1]
  };

  explicit PoseFilter(const PoseTrackerConfig& config);

  [[nodiscard]] State begin(const Measurement& measurement) const;
  [[nodiscard]] State predicted(const State& state, double seconds) const;
  [[nodiscard]] double distance(const State& state, const Measurement& measurement) const;
  void correct(State& state, const Measurement& measurement) const;

 private:
  void add_noise(Matrix12d& covariance, const Eigen::Vector3d& turning, double seconds) const;

  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();           // of a new track
  Eigen::Matrix3d velocity_variance_ = Eigen::Matrix3d::Zero();  // likewise
  Eigen::Matrix3d acceleration_ = Eigen::Matrix3d::Zero();       // spectral densities, squared
  Eigen::Matrix3d drift_ = Eigen::Matrix3d::Zero();
  double turn_variance_ = 0;
  double angular_acceleration_ = 0;
  double angular_drift_ = 0;
};

}  // namespace penumbra::detail
