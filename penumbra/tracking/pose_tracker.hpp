// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/targets/target.hpp>
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
  still               ///< position and orientation stay; accepted poses are averaged
};

/// What is unknown of a target's motion is white noise: sigmas grow with its spectral density q, by
/// q t sqrt(t / 3) for an acceleration and by q sqrt(t) for a drift. docs/tracking.md says how to
/// choose them.
struct PoseTrackerConfig {
  Motion motion = Motion::constant_twist;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< for along_direction; fixed frame
  /// m/s along it, where it is known; nothing: estimated.
  std::optional<double> speed = std::nullopt;
  double position_sigma = 0.005;     ///< of an estimate without covariance, metres per axis
  double orientation_sigma = 0.03;   ///< likewise, radians
  double acceleration = 0.5;         ///< of what has a velocity that is filtered, m/s^2/sqrt(Hz)
  double angular_acceleration = 1;   ///< of constant_twist, rad/s^2/sqrt(Hz)
  double drift = 0.005;              ///< of the other directions, m/sqrt(s): of `still` all, of
                                     ///< along_direction across, and along where speed is known
  double angular_drift = 0.02;       ///< of all but constant_twist, rad/sqrt(s)
  double speed_sigma = 0.5;          ///< of a new track's unknown velocity, m/s per axis
  double angular_speed_sigma = 1.0;  ///< likewise, rad/s
  double timeout = 3.0;              ///< seconds since the last accepted estimate; then lost
  double gate = 16.8;  ///< squared Mahalanobis distance above which an estimate is an outlier;
                       ///< the 99 % quantile of chi^2 with 6 degrees of freedom
  std::size_t gate_patience = 5;  ///< outliers in a row, consistent with each other by the same
                                  ///< gate, that make a new track
  double memory = 1.0;            ///< seconds back to which late estimates are taken in their order
  std::size_t max_estimates = 128;  ///< that are remembered, 3 kB each: the oldest go first
  /// The worst verdict with which estimates are accepted, of visible < partial < hidden; the others
  /// never are. Nothing: visible; and partial if PoseEstimate::seen says that at least 0.4 was
  /// seen.
  std::optional<Verdict> worst = std::nullopt;

  /// Throws InputError, with the values it got. Sigmas are in 1e-9 to 1e9.
  void check() const;
};

struct PoseEstimate {
  std::int64_t stamp = 0;  ///< of the image that it was found in, nanoseconds
  /// In a fixed frame, metres. A rotation up to 1e-4, else refused as invalid.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  /// Of position and of the rotation vector, fixed frame: true rotation = Exp(vector) * estimated.
  std::optional<Matrix6d> covariance = std::nullopt;
  /// Share of the target that was seen, 0 to 1: the less, the less the estimate counts. Nothing:
  /// not known, and it counts fully.
  std::optional<double> seen = std::nullopt;
};

/// Of a target of which nothing is known: lost, with infinite age and variances.
struct TrackedPose {
  Source source = Source::lost;
  double age = std::numeric_limits<double>::infinity();  ///< seconds since the last accepted one
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();  ///< linear and angular velocity, fixed frame
  Matrix6d covariance =               ///< of position and rotation vector, as an estimate's
      Vector6d::Constant(std::numeric_limits<double>::infinity()).asDiagonal();
};

/// Follows one target's pose: a Kalman filter on R^3 x SO(3) that takes an estimate only if enough
/// of its target was visible, and predicts the pose meanwhile.
///
/// If the share s of the target was seen, its estimate has the weight w = s^5 (0.4^5 if less was
/// seen): its covariance is divided by w, and its gate is multiplied by w. Such estimates are less
/// exact, and more often wrong. The power is measured (docs/experiments.md).
///
/// Estimates may come late and out of order: what is known at any stamp depends on which estimates
/// came, not on when, as long as none was refused_late. A late one may therefore also change what
/// was said before of later ones (accepted or an outlier). Only the order of estimates of one stamp
/// counts: the first stays.
///
/// Time is what stamps say. A clock that jumps back makes all estimates late, as one estimate from
/// the far future does: reset() then.
///
/// Nothing is allocated once max_estimates, or what `memory` holds at the rate of estimates, was
/// seen. One tracker is for one thread at a time; at() may run in several.
class PoseTracker {
 public:
  explicit PoseTracker(const PoseTrackerConfig& config = {});  ///< throws as the config's check
  ~PoseTracker();
  PoseTracker(PoseTracker&&) noexcept;
  PoseTracker& operator=(PoseTracker&&) noexcept;

  /// `verdict`: of the target at the estimate's stamp. An estimate in order costs one step of the
  /// filter, a late one also one for each later estimate.
  Outcome update(const PoseEstimate& estimate, Verdict verdict);

  /// The target at a stamp, nanoseconds: the estimates up to then, carried on. Before the first, or
  /// before what is remembered: nothing is known. A lost target is carried on too, for who wants to
  /// search for it.
  [[nodiscard]] TrackedPose at(std::int64_t stamp) const;

  void reset();  ///< forgets all estimates

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
