// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <penumbra/robot/trajectory.hpp>

#include <io/ros/moveit_messages.hpp>

namespace penumbra::io {

/// The newest motion that was planned for a robot, or sent to its controller.
class PlanInput {
 public:
  /// Takes a motion of one robot of several, `name`, or of the only one, at `positions`, in the
  /// order of Robot::variables(). A message without points ends the motion. Returns why it cannot
  /// be used, one line, and forgets the motion before; or nothing.
  std::string take(const JointTrajectoryMessage& message, const std::string& name,
                   const Robot& robot, std::span<const double> positions);
  std::string take(const DisplayTrajectoryMessage& message, const std::string& name,
                   const Robot& robot, std::span<const double> positions);

  [[nodiscard]] const std::shared_ptr<const Trajectory>& plan() const { return plan_; }

 private:
  std::string set(std::vector<std::string> joints, std::vector<TrajectoryPoint> points,
                  const std::string& name, const Robot& robot, std::span<const double> positions);

  std::shared_ptr<const Trajectory> plan_;
};

}  // namespace penumbra::io
