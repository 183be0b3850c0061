// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/base/setting.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {

/// The source of a handled target's position.
enum class Source {
  measured,   ///< an accepted estimate of exactly this stamp
  predicted,  ///< extrapolated from the last accepted estimates, or moved by the link that carries
              ///< it (Verdict::held)
  held,       ///< the last accepted estimates; the target is assumed not to move
  lost        ///< no accepted estimate within the time-out
};

/// The source's name in report.json.
[[nodiscard]] std::string_view to_string(Source source);

/// The result of passing an estimate to a tracker.
enum class Outcome {
  accepted,
  refused_verdict,  ///< the target was not visible enough
  refused_gate,     ///< an outlier: too far from the predicted target
  refused_late,     ///< older than the remembered estimates
  refused_invalid   ///< not finite, not a rotation, an invalid covariance, in a link whose pose is
                    ///< unknown, or the second estimate of its stamp
};

[[nodiscard]] std::string_view to_string(Outcome outcome);

/// Linear before angular components, in rows and columns.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The motion of a target while it is hidden.
enum class Motion {
  constant_twist,     ///< filtered linear velocity in the fixed frame, and angular velocity
  constant_velocity,  ///< fixed orientation
  along_direction,    ///< a conveyor: velocity along a known direction, fixed orientation
  still               ///< fixed position and orientation; accepted poses are averaged
};

[[nodiscard]] std::string_view to_string(Motion motion);

namespace detail {

/// Ranges of sigmas whose squares and their products with seconds stay within double's range.
inline constexpr SettingRange positive{1e-9, 1e9}, not_negative{0, 1e9}, finite{-1e9, 1e9};

/// The settings of all trackers.
template <class C>
constexpr auto track_settings(SettingRange motions) {
  return std::tuple(
      Setting("motion", &C::motion, motions, "", "how it moves while nobody sees it"),
      Setting("acceleration", &C::acceleration, not_negative, "m/s^2/sqrt(Hz)",
              "spectral density of white acceleration, where velocity is filtered"),
      Setting("speed_sigma", &C::speed_sigma, not_negative, "m/s",
              "of a new track's unknown velocity, per axis"),
      Setting("timeout", &C::timeout, positive, "s",
              "since the last accepted estimate; then the target is lost"),
      Setting("gate", &C::gate, positive, "",
              "squared Mahalanobis distance above which an estimate is an outlier"),
      Setting("gate_patience", &C::gate_patience, {1, 1e9}, "",
              "outliers in a row, consistent with each other by the gate, that make a new track"),
      Setting("memory", &C::memory, not_negative, "s",
              "how far back late estimates are taken in their order"),
      Setting("max_estimates", &C::max_estimates, {2, 1e9}, "",
              "that are remembered; the oldest go first"),
      Setting("worst", &C::worst, {0, static_cast<double>(Verdict::hidden)}, "",
              "the worst verdict for accepting estimates, of visible < partial < hidden"));
}

}  // namespace detail

/// Unknown motion is modelled as white noise of spectral density q: sigmas grow by
/// q t sqrt(t / 3) for an acceleration and by q sqrt(t) for a drift. docs/tracking.md explains how
/// to choose them.
struct PoseTrackerConfig {
  Motion motion = Motion::constant_twist;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::optional<double> speed = std::nullopt;
  double position_sigma = 0.005;
  double orientation_sigma = 0.03;
  double acceleration = 0.5;
  double angular_acceleration = 1;
  double drift = 0.005;
  double angular_drift = 0.02;
  double speed_sigma = 0.5;
  double angular_speed_sigma = 1.0;
  double timeout = 3.0;
  double gate = 16.8;  ///< the 99 % quantile of chi^2 with 6 degrees of freedom
  std::size_t gate_patience = 5;
  double memory = 1.0;
  std::size_t max_estimates = 128;              ///< 3 kB each
  std::optional<Verdict> worst = std::nullopt;  ///< null: visible, and partial if 0.4 was seen

  static constexpr auto settings() {
    using C = PoseTrackerConfig;
    constexpr auto not_negative = detail::not_negative, positive = detail::positive;
    constexpr std::tuple own(
        Setting("direction", &C::direction, {}, "", "of along_direction, in the fixed frame"),
        Setting("speed", &C::speed, detail::finite, "m/s", "along direction; none: estimated"),
        Setting("position_sigma", &C::position_sigma, positive, "m",
                "of an estimate without covariance, per axis"),
        Setting("orientation_sigma", &C::orientation_sigma, positive, "rad", "likewise"),
        Setting("angular_acceleration", &C::angular_acceleration, not_negative, "rad/s^2/sqrt(Hz)",
                "of constant_twist"),
        Setting("drift", &C::drift, not_negative, "m/sqrt(s)",
                "of directions without a filtered velocity"),
        Setting("angular_drift", &C::angular_drift, not_negative, "rad/sqrt(s)",
                "of all motions except constant_twist"),
        Setting("angular_speed_sigma", &C::angular_speed_sigma, not_negative, "rad/s",
                "of a new track's unknown angular velocity"));
    return std::tuple_cat(detail::track_settings<C>({0, 3}), own);
  }

  /// Throws InputError with the invalid value.
  void check() const;
};

struct PoseEstimate {
  std::int64_t stamp = 0;  ///< of its image, nanoseconds
  /// In a fixed frame, metres. Refused as invalid if the rotation is off by more than 1e-4.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  /// Of position and of the rotation vector, fixed frame: true rotation = Exp(vector) * estimated.
  std::optional<Matrix6d> covariance = std::nullopt;
  /// Fraction of the target that was seen, 0 to 1, which weights the estimate. Null: full weight.
  std::optional<double> seen = std::nullopt;
};

/// A pose at a stamp. Without any estimate: lost, with infinite age and variances.
struct TrackedPose {
  Source source = Source::lost;
  double age = std::numeric_limits<double>::infinity();  ///< seconds since the last accepted one
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();  ///< linear and angular velocity, fixed frame
  Matrix6d covariance =               ///< of position and rotation vector, as an estimate's
      Vector6d::Constant(std::numeric_limits<double>::infinity()).asDiagonal();
};

/// Follows one target's pose with a Kalman filter on R^3 x SO(3). Accepts an estimate only if
/// enough of its target was visible, and predicts the pose in between.
///
/// If the fraction s of the target was seen, its estimate has the weight w = s^5 (0.4^5 if less was
/// seen): its covariance is divided by w and its gate multiplied by w, because such estimates are
/// less accurate and more often wrong. The power is measured (research/README.md).
///
/// Estimates may be late and out of order. The result depends on which estimates arrived, not on
/// when, as long as none was refused_late. A late estimate may therefore turn later ones into
/// outliers or the reverse. Of two estimates of one stamp the first is used.
///
/// After a clock jumps back, or after an estimate from the far future, all estimates are late: call
/// reset().
///
/// Allocates nothing once max_estimates, or the estimates within `memory`, were received. One
/// instance serves one thread at a time; at() may run in several.
class PoseTracker {
 public:
  explicit PoseTracker(const PoseTrackerConfig& config = {});  ///< throws as config.check()
  ~PoseTracker();
  PoseTracker(PoseTracker&&) noexcept;
  PoseTracker& operator=(PoseTracker&&) noexcept;

  /// `verdict`: of the target at the estimate's stamp. Costs one filter step, and another one for
  /// each estimate with a later stamp.
  Outcome update(const PoseEstimate& estimate, Verdict verdict);

  /// Returns the target at a stamp, nanoseconds, extrapolated from the estimates up to then (also
  /// for a lost target). It is lost before the first remembered estimate.
  [[nodiscard]] TrackedPose at(std::int64_t stamp) const;

  void reset();  ///< forgets all estimates

 private:
  struct State;
  std::unique_ptr<State> state_;
};

enum class PointMotion {
  hold,              ///< the last trusted position (handover in the paper)
  constant_velocity  ///< predicted with filtered velocity
};

[[nodiscard]] std::string_view to_string(PointMotion motion);

struct PointTrackerConfig {
  PointMotion motion = PointMotion::hold;
  double sigma = 0.01;
  double acceleration = 2.0;
  double speed_sigma = 1.0;
  double held_speed = 0.5;
  double timeout = 3.0;
  double gate = 11.3;  ///< the 99 % quantile of chi^2 with 3 degrees of freedom
  std::size_t gate_patience = 5;
  double memory = 1.0;
  std::size_t max_estimates = 128;  ///< 1 kB each
  Verdict worst = Verdict::visible;

  static constexpr auto settings() {
    using C = PointTrackerConfig;
    constexpr std::tuple own(Setting("sigma", &C::sigma, detail::positive, "m",
                                     "of an estimate without covariance, per axis"),
                             Setting("held_speed", &C::held_speed, detail::not_negative, "m/s",
                                     "per axis, by which a held point's sigma grows"));
    return std::tuple_cat(detail::track_settings<C>({0, 1}), own);
  }

  void check() const;  ///< throws InputError with the invalid value
};

struct PointEstimate {
  std::int64_t stamp = 0;                              ///< nanoseconds
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in a fixed frame, metres
  std::optional<Eigen::Matrix3d> covariance = std::nullopt;
};

/// A point at a stamp. Without any estimate: lost, with infinite age and variances.
struct TrackedPoint {
  Source source = Source::lost;
  double age = std::numeric_limits<double>::infinity();  ///< seconds since the last accepted one
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< 0 while it is held
  Eigen::Matrix3d covariance =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()).asDiagonal();
};

/// Follows one point. Verdicts, late estimates, outliers and time are handled as in PoseTracker.
class PointTracker {
 public:
  explicit PointTracker(const PointTrackerConfig& config = {});  ///< throws as config.check()
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
