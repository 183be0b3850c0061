// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Where a planned motion passes, and when.
struct TrajectoryPoint {
  double time = 0.0;                       ///< seconds from the start of the motion, >= 0
  std::vector<double> positions = {};      ///< rad and m, one for each variable of the motion
  std::vector<double> velocities = {};     ///< of these, per second; empty: not given
  std::vector<double> accelerations = {};  ///< per second squared; empty: not given
};

/// A planned motion. Between two points it is what ros2_control's joint_trajectory_controller
/// makes: linear if one of them lacks velocities, cubic if one lacks accelerations, else quintic.
/// If the first point's time is above 0, the robot moves there from rest at `start`.
class Trajectory {
 public:
  static constexpr double max_duration = 3600.0;  ///< seconds

  /// `variables`: names of Robot::variables(), in the order of the points' values; the others stay
  /// at `start`, which has all, in the order of Robot::variables(). Values of joints that mimic are
  /// ignored. Throws InputError, with the number of the point, for unknown or repeated names, no
  /// points, times that are negative, above max_duration or do not rise, another number of values
  /// than of names, values beyond +-Robot::max_position, accelerations without velocities, and
  /// velocities that contradict positions and times, as with times in milliseconds; and
  /// std::invalid_argument for a start of another size.
  Trajectory(const Robot& robot, std::span<const std::string> variables,
             std::vector<TrajectoryPoint> points, std::span<const double> start);

  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] double duration() const { return points_.back().time; }  ///< seconds
  [[nodiscard]] std::span<const TrajectoryPoint> points() const { return points_; }

  /// Sets where variables are that it does not move; of all, in the order of Robot::variables().
  void set_others(std::span<const double> positions);

  /// Writes the positions of all variables at a time; those of the nearest end outside of the
  /// motion. Allocates nothing.
  void at(double time, std::span<double> positions) const;

  /// The variable that differs most from `start` where the motion begins: rad or m. 0 if the first
  /// point's time is above 0, since the robot moves there.
  struct Jump {
    std::size_t variable = 0;
    double by = 0.0;
  };
  [[nodiscard]] Jump jump() const { return jump_; }

  /// One line for each likely mistake: joints that exceed a limit of the URDF, of position at a
  /// point or of velocity, with the largest excess; and a motion so slow that its times may be in
  /// milliseconds.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Fastest {
    double speed = 0.0, at = 0.0;  // rad/s or m/s; seconds
  };
  [[nodiscard]] Fastest fastest(std::size_t i) const;
  void append_limits(const Joint& joint, std::size_t i, std::vector<std::string>& lines) const;
  [[nodiscard]] std::string slow_line() const;

  Robot robot_;
  std::vector<std::optional<std::size_t>> variables_;  // null: mimics
  std::vector<TrajectoryPoint> points_;
  std::vector<double> start_;
  Jump jump_;
};

}  // namespace penumbra
