// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>
#include <sstream>

#include <penumbra/poses/robot_pose.hpp>

namespace penumbra {
namespace {

/// The first dispute, and which other joints are disputed.
std::string describe_disputes(const Robot& robot, std::span<const JointDispute> disputes) {
  if (disputes.empty()) return "two programs publish different joint positions";
  const JointDispute& first = disputes.front();
  std::ostringstream text;
  text.precision(4);
  text << "joint '" << robot.variables()[first.variable] << "' is at " << first.values[0] << " by "
       << first.sources[0] << " and at " << first.values[1] << " by " << first.sources[1] << " ("
       << first.stamp << " ns)";
  for (const JointDispute& other : disputes.subspan(1))
    text << (&other == &disputes[1] ? "; so is '" : ", '") << robot.variables()[other.variable]
         << "'";
  return text.str();
}

/// Returns why a joint's position at a stamp is not known.
std::string reason_of(const JointGap& gap, std::int64_t stamp) {
  if (gap.jump)
    return "jumps by " + std::to_string(*gap.jump) + " next to the stamp, more than it can move";
  if (gap.why != JointStatus::stale) return "never seen";
  std::string text = "no position near the stamp";
  if (!gap.last_seen) return text;
  text += ", the last is " + std::to_string((stamp - *gap.last_seen) / 1'000'000) + " ms older";
  if (!gap.source.empty()) text += ", by " + gap.source + std::string(others_unused);
  return text;
}

}  // namespace

std::string_view to_string(FrameStatus status) {
  constexpr std::array<std::string_view, 9> names = {"ok",
                                                     "missing_link",
                                                     "bad_depth",
                                                     "missing_depth",
                                                     "poses_disagree",
                                                     "stale_transform",
                                                     "missing_transform",
                                                     "stale_joints",
                                                     "missing_joints"};
  return names[static_cast<std::size_t>(status)];
}

std::vector<Body> bodies_of(const Robot& robot) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], robot.meshes(i)});
  return bodies;
}

RobotPose pose_of(const Robot& robot, const JointAnswer& joints) {
  const FrameStatus status = status_of(joints.status);
  if (status != FrameStatus::ok) return {.status = status, .message = describe(robot, joints)};
  return {.positions = joints.positions, .age = joints.age};
}

FrameStatus status_of(JointStatus joints) {
  switch (joints) {
    case JointStatus::ok:
      return FrameStatus::ok;
    case JointStatus::stale:
      return FrameStatus::stale_joints;
    case JointStatus::disputed:
      return FrameStatus::poses_disagree;
    case JointStatus::missing:
      break;
  }
  return FrameStatus::missing_joints;
}

std::string describe(const Robot& robot, const JointAnswer& joints) {
  if (joints.status == JointStatus::disputed) return describe_disputes(robot, joints.disputes);
  if (joints.gaps.empty()) return "no joint positions";
  std::string text;
  for (auto first = joints.gaps.begin(); first != joints.gaps.end();) {
    const std::string reason = reason_of(*first, joints.stamp);
    const auto end = std::find_if(first, joints.gaps.end(), [&](const JointGap& gap) {
      return reason_of(gap, joints.stamp) != reason;
    });
    constexpr std::ptrdiff_t most_named = 3;
    text += (text.empty() ? "" : "; ") + std::string(end - first > 1 ? "joints" : "joint");
    for (auto gap = first; gap < std::min(end, first + most_named); ++gap)
      text += (gap == first ? " '" : ", '") + robot.variables()[gap->variable] + "'";
    if (end - first > most_named)
      text += " and " + std::to_string(end - first - most_named) + " more";
    text += ": " + reason;
    first = end;
  }
  return text;
}

}  // namespace penumbra
