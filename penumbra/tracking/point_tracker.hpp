// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include <penumbra/targets/target.hpp>
#include <penumbra/tracking/track.hpp>

namespace penumbra {

enum class PointMotion {
  hold,              ///< the last trusted position as it was (handover in the paper)
  constant_velocity  ///< predicted with filtered velocity
};

struct PointTrackerConfig {
  PointMotion motion = PointMotion::hold;
  double sigma = 0.01;               ///< of an estimate without covariance, metres per axis
  double acceleration = 2.0;         ///< of constant_velocity: spectral density of white
                                     ///< acceleration, m/s^2/sqrt(Hz)
  double speed_sigma = 1.0;          ///< likewise: of a new track's velocity, m/s per axis
  double held_speed = 0.5;           ///< m/s per axis by which a held point's sigma grows
  double timeout = 3.0;              ///< seconds since the last accepted estimate; then lost
  double gate = 11.3;                ///< squared Mahalanobis distance above which an estimate is an
                                     ///< outlier: 99 % of chi^2 with 3 degrees of freedom
  std::size_t gate_patience = 5;     ///< outliers in a row, consistent with each other by the same
                                     ///< gate, that make a new track
  double memory = 1.0;               ///< seconds back to which late estimates are taken in order
  std::size_t max_estimates = 128;   ///< that are remembered, 1 kB each: the oldest go first
  Verdict worst = Verdict::visible;  ///< the worst verdict with which estimates are accepted, of
                                     ///< visible < partial < hidden; the others never are

  void check() const;  ///< throws InputError, with the values it got; sigma is in 1e-9 to 1e9
};

struct PointEstimate {
  std::int64_t stamp = 0;                              ///< nanoseconds
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in a fixed frame, metres
  std::optional<Eigen::Matrix3d> covariance = std::nullopt;
};

/// Of a target of which nothing is known: lost, with infinite age and variances.
struct TrackedPoint {
  Source source = Source::lost;
  double age = std::numeric_limits<double>::infinity();  ///< seconds since the last accepted one
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< 0 while it is held
  Eigen::Matrix3d covariance =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()).asDiagonal();
};

/// Follows one point, as PoseTracker follows a pose: the same rules for verdicts, late estimates,
/// outliers and time.
class PointTracker {
 public:
  explicit PointTracker(const PointTrackerConfig& config = {});  ///< throws as the config's check
  ~PointTracker();
  PointTracker(PointTracker&&) noexcept;
  PointTracker& operator=(PointTracker&&) noexcept;

  Outcome update(const PointEstimate& estimate, Verdict verdict);
  [[nodiscard]] TrackedPoint at(std::int64_t stamp) const;
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
