// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/robot/trajectory.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// A camera that will see the motion. Its images are the rectified ones.
struct ForecastCamera {
  std::string name;
  Camera camera;
  LabelRule rule = {};  ///< its tolerance separates robot and target
};

/// A target, and how it moves unless a link carries it. A shape in the camera's frame or in pixels
/// is the first camera's at the start of the motion. A modal region is unknown if the robot is next
/// to it then. A box, polygon or key point with an expected depth, or a height, becomes a flat
/// outline in space; other regions can be judged only in a camera whose pose is the first camera's
/// at the start.
struct ForecastTarget {
  Target target;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< in the root's frame, m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< about its origin, rad/s
};

/// What the robot alone does to a target in one camera at one time.
struct Prediction {
  Verdict verdict = Verdict::unknown;
  double hidden = 0.0;  ///< share of the target's pixels in the image
  /// Pixels between the target and the nearest part of the robot that could hide it, 0 where they
  /// touch; below 0: how far the innermost hidden pixel of the target is from one that is not
  /// hidden. Never beyond +-LookAheadConfig::clearance.
  double clearance = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown, not measured
  std::string by = {};      ///< the link, or attached body, that hides most of it; else empty
  std::string reason = {};  ///< one line if the verdict is unknown, else empty
};

/// What a camera, or all of them together, will see of a target.
struct CameraForecast {
  Forecast intervals;         ///< of all of the motion
  std::vector<double> times;  ///< of `predictions`; empty for all cameras together
  std::vector<Prediction> predictions;

  /// Seconds until it gets hidden, and until it is seen again; null: never.
  [[nodiscard]] std::optional<double> hidden_at() const;
  [[nodiscard]] std::optional<double> seen_again_at() const;
  [[nodiscard]] double seen_for() const;  ///< seconds: sum of VerdictInterval::seen
};

struct TargetForecast {
  std::string name;
  std::vector<CameraForecast> cameras;  ///< in the order of the cameras
  /// Of all cameras: seen if one sees it; then unknown, hidden, out of view.
  CameraForecast any;
};

struct LookAheadConfig {
  int threads = 1;
  double step = 0.02;  ///< seconds between samples at most; more if a motion would have over 36,000
  /// Of a target's smaller side in the image, that a part of the robot next to it, or the target
  /// itself, moves at most between two samples, unless they are 1 ms apart, or in motions of more
  /// than 3 minutes a 180,000th of it.
  double motion = 0.25;
  double border = 0.005;  ///< seconds by which an interval's begin and end may be off
  /// Pixels up to which Prediction::clearance is measured, to 127; 0: it is not, which saves time.
  int clearance = 64;
};

/// Says what a motion of the robot will hide, when, for how long, and by which link, if nothing
/// else moves: from renders of the robot next to each target, without a depth image. Serves one
/// thread at a time.
class LookAhead {
 public:
  /// `start`: the robot in which shapes in a camera's frame are given, by its positions, what its
  /// links carry, links whose pose is not known, and, if given, the first camera's pose. A target
  /// with the name of what is carried is held. Throws InputError for no cameras, an unknown parent,
  /// cameras that Pipeline would refuse, targets that are invalid in every frame, and settings out
  /// of range; and std::invalid_argument for another number of positions than Robot::variables().
  LookAhead(const Robot& robot, std::vector<ForecastCamera> cameras,
            const std::vector<ForecastTarget>& targets, RobotPose start,
            const LookAheadConfig& config = {});
  ~LookAhead();
  LookAhead(LookAhead&&) noexcept;
  LookAhead& operator=(LookAhead&&) noexcept;

  /// Begins anew with other targets, and another start. Quick where the same is carried. Throws as
  /// the constructor.
  void set(const std::vector<ForecastTarget>& targets, RobotPose start);

  /// Returns a forecast for each target, in times of the motion. It need not begin at `start`.
  /// `from`, `until`: the part of the motion, seconds; targets are where they are at the start
  /// then.
  [[nodiscard]] std::vector<TargetForecast> along(
      const Trajectory& trajectory, double from = 0.0,
      double until = std::numeric_limits<double>::infinity());

  /// What planners ask.
  struct Seen {
    float hidden = 0.0F;     ///< share; NaN: unknown, or out of view
    float clearance = 0.0F;  ///< as Prediction::clearance
  };
  /// Returns what a camera sees of the targets, where they are at the start, in N configurations:
  /// N rows of a value per target. `positions`: N rows of Robot::variables(). Throws
  /// std::invalid_argument for another number of values.
  [[nodiscard]] std::vector<Seen> visibility(std::size_t camera, std::span<const double> positions);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A motion among others.
struct RankedMotion {
  std::size_t trajectory = 0;  ///< index
  double seen = 0.0;           ///< share of the motion for which a camera sees a target, 0 to 1
  std::string reason;          ///< what costs most, one line; empty if nothing gets hidden
};

/// Orders motions by the share of time for which their targets stay visible, the best first; equal
/// ones by duration. `forecasts`: LookAhead::along() of each.
[[nodiscard]] std::vector<RankedMotion> rank(
    std::span<const std::vector<TargetForecast>> forecasts);

}  // namespace penumbra
