// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::test {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// A target's whole state, components in the order of its errors: position, orientation, linear and
/// angular velocity.
struct Node {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();
};

/// The stochastic model of a motion, by what drives each component.
struct MotionModel {
  Vector12d density = Vector12d::Zero();  ///< white noise into each component, squared
  Vector6d twist = Vector6d::Zero();      ///< of a new track: mean and variances
  Vector6d twist_variance = Vector6d::Zero();

  /// The components that can change: poses and the velocities that have noise or variance.
  [[nodiscard]] std::vector<int> active() const;
  /// Covariance that the noise adds over some time, by matrix exponential (Van Loan, "Computing
  /// integrals involving the matrix exponential", 1978).
  [[nodiscard]] Matrix12d noise(const Eigen::Vector3d& turning, double seconds) const;
  /// The motion without noise.
  [[nodiscard]] static Node carried_on(const Node& node, double seconds);
};

struct SeenPose {
  double seconds = 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Identity();
};

struct Smoothed {
  std::vector<Node> nodes;
  Matrix12d last_covariance = Matrix12d::Zero();
};

/// The most likely states at all stamps at once: Gauss and Newton's method on a dense matrix, with
/// derivatives by differences.
Smoothed smooth(const MotionModel& model, const std::vector<SeenPose>& seen);

}  // namespace penumbra::test
