// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include <penumbra/occlusion/target.hpp>
#include <penumbra/tracking/track.hpp>

namespace penumbra {

enum class PointMotion {
  hold,              ///< the last trusted position (handover in the paper)
  constant_velocity  ///< predicted with filtered velocity
};

struct PointTrackerConfig {
  PointMotion motion = PointMotion::hold;
  double sigma = 0.01;               ///< of an estimate, metres
  double acceleration = 2.0;         ///< spectral density of white acceleration, m/s^2/sqrt(Hz)
  double held_speed = 0.5;           ///< m/s by which a held point's sigma grows
  double timeout = 3.0;              ///< seconds since the last accepted estimate; then lost
  double gate = 11.3;                ///< squared Mahalanobis distance: 99 % of chi^2 with 3 degrees
  std::size_t gate_patience = 5;     ///< consistent outliers in a row that make a new track
  double memory = 1.0;               ///< seconds back to which late estimates are taken
  Verdict worst = Verdict::visible;  ///< the worst verdict with which estimates are accepted

  void check() const;  ///< throws InputError, with the values it got
};

struct PointEstimate {
  std::int64_t stamp = 0;                              ///< nanoseconds
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in a fixed frame, metres
  std::optional<Eigen::Matrix3d> covariance;
};

struct TrackedPoint {
  Source source = Source::lost;
  double age = 0;  ///< seconds since the last accepted estimate; infinite before the first
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Follows one point, as PoseTracker follows a pose.
class PointTracker {
 public:
  explicit PointTracker(const PointTrackerConfig& config = {});
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
