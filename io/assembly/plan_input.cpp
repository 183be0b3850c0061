// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <penumbra/base/error.hpp>

#include <io/assembly/plan_input.hpp>

namespace penumbra::io {
namespace {

/// Appends a part, which begins where the last one ended.
void append(const JointTrajectoryMessage& part, std::vector<TrajectoryPoint>& points) {
  const bool is_later = !points.empty();
  const double after = is_later ? points.back().time : 0.0;
  for (const JointTrajectoryMessage::Point& point : part.points) {
    const double time = point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec;
    if (is_later && time == 0.0 && &point == &part.points.front()) continue;
    points.push_back({after + time, point.positions, point.velocities, point.accelerations});
  }
}

}  // namespace

std::string PlanInput::take(const JointTrajectoryMessage& message, const std::string& name,
                            const Robot& robot, std::span<const double> positions) {
  std::vector<TrajectoryPoint> points;
  append(message, points);
  return set(message.joint_names, std::move(points), name, robot, positions);
}

std::string PlanInput::take(const DisplayTrajectoryMessage& message, const std::string& name,
                            const Robot& robot, std::span<const double> positions) {
  plan_.reset();
  std::vector<std::string> joints;
  std::vector<TrajectoryPoint> points;
  for (const DisplayTrajectoryMessage::Part& part : message.parts) {
    if (!part.floating.points.empty()) return "motions of floating and planar joints are not read";
    if (part.joints.points.empty()) continue;
    if (!points.empty() && part.joints.joint_names != joints)
      return "its parts move different joints";
    joints = part.joints.joint_names;
    append(part.joints, points);
  }
  return set(std::move(joints), std::move(points), name, robot, positions);
}

std::string PlanInput::set(std::vector<std::string> joints, std::vector<TrajectoryPoint> points,
                           const std::string& name, const Robot& robot,
                           std::span<const double> positions) {
  plan_.reset();
  if (points.empty()) return {};
  if (!name.empty())
    for (std::string& joint : joints) joint.insert(0, name + "/");
  try {
    plan_ = std::make_shared<const Trajectory>(robot, joints, std::move(points), positions);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace penumbra::io
