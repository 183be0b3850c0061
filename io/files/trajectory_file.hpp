// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <penumbra/robot/trajectory.hpp>

namespace penumbra::io {

/// A motion as a file gives it.
struct FileTrajectory {
  std::string name;                      ///< the path, with a number from the second one on
  std::vector<std::string> variables{};  ///< joint names
  std::vector<TrajectoryPoint> points{};
};

/// Reads the motions of a file, at least one: CSV with the header "time,JOINT,..." (seconds, rad
/// and m); or messages of ROS 2 or ROS 1 in YAML or JSON, as `ros2 topic echo` prints them, of
/// trajectory_msgs/JointTrajectory, moveit_msgs/RobotTrajectory or DisplayTrajectory, whose parts
/// follow one another, or goals of control_msgs/FollowJointTrajectory. Throws InputError that names
/// file and line.
[[nodiscard]] std::vector<FileTrajectory> read_trajectories(const std::filesystem::path& file);

}  // namespace penumbra::io
