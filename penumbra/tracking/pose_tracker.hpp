// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/occlusion/target.hpp>
#include <penumbra/tracking/track.hpp>

namespace penumbra {

/// Linear before angular, as rows and columns too.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// How a target moves while nobody sees it.
enum class Motion {
  constant_twist,     ///< linear velocity in the fixed frame, angular velocity, both filtered
  constant_velocity,  ///< the orientation stays
  along_direction,    ///< a conveyor: velocity along a known direction, the orientation stays
  still               ///< the last accepted pose is held
};

struct PoseTrackerConfig {
  Motion motion = Motion::constant_twist;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< for along_direction; fixed frame
  std::optional<double> speed;        ///< m/s along it, where it is known; nothing: estimated
  double position_sigma = 0.005;      ///< of an estimate without covariance, metres
  double orientation_sigma = 0.03;    ///< likewise, radians
  double acceleration = 0.5;          ///< spectral density of white acceleration, m/s^2/sqrt(Hz)
  double angular_acceleration = 1.0;  ///< likewise, rad/s^2/sqrt(Hz)
  double timeout = 3.0;               ///< seconds since the last accepted estimate; then lost
  double gate = 16.8;  ///< squared Mahalanobis distance above which an estimate is an outlier;
                       ///< the 99 % quantile of chi^2 with 6 degrees of freedom
  std::size_t gate_patience = 5;  ///< consistent outliers in a row that make a new track
  double memory = 1.0;            ///< seconds back to which late estimates are taken in their order
  Verdict worst = Verdict::visible;  ///< the worst verdict with which estimates are accepted

  /// Throws InputError, with the values it got.
  void check() const;
};

struct PoseEstimate {
  std::int64_t stamp = 0;  ///< of the image that it was found in, nanoseconds
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in a fixed frame, metres
  std::optional<Matrix6d> covariance;  ///< of position and of the rotation vector, fixed frame
};

struct TrackedPose {
  Source source = Source::lost;
  double age = 0;  ///< seconds since the last accepted estimate; infinite before the first
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();       ///< linear and angular velocity, fixed frame
  Matrix6d covariance = Matrix6d::Zero();  ///< of position and of the rotation vector
};

/// Follows one target's pose: a Kalman filter on SE(3) that takes an estimate only where its target
/// was visible, and predicts it meanwhile.
class PoseTracker {
 public:
  explicit PoseTracker(const PoseTrackerConfig& config = {});  ///< throws as the config's check
  ~PoseTracker();
  PoseTracker(PoseTracker&&) noexcept;
  PoseTracker& operator=(PoseTracker&&) noexcept;

  /// `verdict`: of the target at the estimate's stamp. Estimates may come late and out of order.
  Outcome update(const PoseEstimate& estimate, Verdict verdict);

  /// The target at a stamp, nanoseconds; also at one before the last estimate, within the memory.
  [[nodiscard]] TrackedPose at(std::int64_t stamp) const;

  void reset();  ///< forgets all estimates

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
