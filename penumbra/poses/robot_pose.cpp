// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>
#include <sstream>

#include <penumbra/base/stamps.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/time/source_tracks.hpp>

namespace penumbra {
namespace {

/// Returns the number of a joint's variables, which are consecutive.
std::size_t variables_of(JointType type) {
  if (type == JointType::planar) return 3;
  return type == JointType::floating ? 7 : 1;
}

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

std::string milliseconds(std::int64_t from, std::int64_t to) {
  return std::to_string(stamp_distance(from, to) / 1'000'000) + " ms";
}

/// Returns 'a', 'b' and 3 more.
std::string some_of(std::span<const std::string> names) {
  constexpr std::size_t most_named = 3;
  std::string text;
  for (const std::string& name : names.first(std::min(names.size(), most_named)))
    text += (text.empty() ? "'" : ", '") + name + "'";
  if (names.size() > most_named)
    text += " and " + std::to_string(names.size() - most_named) + " more";
  return text;
}

std::string between(std::string before, const std::string& text, const std::string& after) {
  before += text;
  before += after;
  return before;
}

/// Returns the text before and after the joints' names in the names that were received, or, if
/// `is_longer`, the reverse, as the setting joint_names has it; empty if they differ otherwise.
std::string common_pattern(std::span<const std::string> wanted,
                           std::span<const std::string> received, bool is_longer) {
  for (const std::string& name : received) {
    const std::string& outer = is_longer ? wanted.front() : name;
    const std::string& inner = is_longer ? name : wanted.front();
    const std::size_t at = outer.find(inner);
    if (at == std::string::npos || inner.empty() || outer.size() == inner.size()) continue;
    const std::string before = outer.substr(0, at), after = outer.substr(at + inner.size());
    const auto is_received = [&](const std::string& joint) {
      return std::ranges::any_of(received, [&](const std::string& other) {
        return is_longer ? between(before, other, after) == joint
                         : between(before, joint, after) == other;
      });
    };
    if (std::ranges::all_of(wanted, is_received))
      return is_longer ? between("*=", between(before, "*", after), "")
                       : between(before, "*", after) + "=*";
  }
  return {};
}

/// Says which names the joint states have in place of the joints that were never seen.
std::string describe_names(const Robot& robot, const JointAnswer& joints) {
  std::vector<std::string> wanted;
  for (const JointGap& gap : joints.gaps)
    if (gap.why == JointStatus::missing && !gap.is_refused)
      wanted.push_back(robot.variables()[gap.variable]);
  if (wanted.empty() || joints.other_names.empty()) return {};
  std::string text = "; the joint states also name " + some_of(joints.other_names);
  for (const bool is_longer : {false, true})
    if (std::string pattern = common_pattern(wanted, joints.other_names, is_longer);
        !pattern.empty())
      return between(text, ": set joint_names '", pattern) + "'";
  return text;
}

/// Returns why a joint's position at a stamp is not known.
std::string reason_of(const JointGap& gap, std::int64_t stamp) {
  if (gap.jump)
    return "jumps by " + std::to_string(*gap.jump) + " next to the stamp, more than it can move";
  if (gap.is_refused) return "its positions are absent or not finite";
  if (gap.why != JointStatus::stale) return "never seen";
  std::string text = "no position near the stamp";
  if (gap.last_seen) text += ", the last is " + milliseconds(*gap.last_seen, stamp) + " older";
  if (gap.next_seen) text += ", the next is " + milliseconds(stamp, *gap.next_seen) + " newer";
  if (!gap.last_seen) return text;
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
  RobotPose pose{.positions = joints.positions, .age = joints.age};
  if (joints.status == JointStatus::ok) return pose;
  std::vector<std::size_t> unknown;
  for (const JointGap& gap : joints.gaps) unknown.push_back(gap.variable);
  if (!joints.disputes.empty() || unknown.empty() || !leave_out(unknown, robot, 0, pose))
    return {.status = status_of(joints.status), .message = describe(robot, joints)};
  pose.uncertain_reason = describe(robot, joints) + remedy_of(robot, joints);
  return pose;
}

std::vector<bool> lost_joints(const Robot& robot, std::span<const std::size_t> unknown,
                              std::span<const std::size_t> disputed) {
  std::vector<bool> is_lost(robot.links().size());
  for (const Joint& joint : robot.joints()) {
    if (!joint.variable) continue;
    const auto moves = [&](std::size_t variable) {
      return *joint.variable <= variable && variable < *joint.variable + variables_of(joint.type);
    };
    const bool is_disputed = std::ranges::any_of(disputed, moves);
    if (is_disputed || std::ranges::any_of(unknown, moves)) is_lost[joint.child] = true;
    const RobotPart* const part = robot.part_of(joint.child);
    if (is_disputed) is_lost[part == nullptr ? 0 : part->first_link] = true;
  }
  return is_lost;
}

bool add_uncertain_links(const Robot& robot, const std::vector<bool>& is_lost,
                         std::size_t camera_parent, std::vector<std::size_t>& uncertain) {
  const std::size_t count = robot.links().size();
  const auto parent = [&](std::size_t link) { return robot.joints()[link - 1].parent; };
  std::vector<bool> leads(count), is_uncertain = is_lost;  // leads: to geometry or the camera
  for (std::size_t link = count; link-- > 0;) {
    if (robot.report()[link].drawn || link == camera_parent) leads[link] = true;
    if (link > 0 && leads[link]) leads[parent(link)] = true;
  }
  const RobotPart whole{{}, 0, count, 0, robot.variables().size()};
  const auto parts = robot.parts().empty() ? std::span(&whole, 1) : robot.parts();
  for (const RobotPart& part : parts) {
    std::size_t known = 0, lost = 0;
    for (std::size_t link = std::max<std::size_t>(1, part.first_link); link < part.end_link; ++link)
      if (leads[link] && robot.joints()[link - 1].type != JointType::fixed)
        ++(is_lost[link] ? lost : known);
    if (lost > 0 && known == 0) is_uncertain[part.first_link] = true;
  }
  for (std::size_t link = 1; link < count; ++link)  // parents come before children
    if (is_uncertain[parent(link)]) is_uncertain[link] = true;
  if (is_uncertain[0] || is_uncertain[camera_parent]) return false;
  for (std::size_t link = 0; link < count; ++link)
    if (is_uncertain[link] && std::ranges::find(uncertain, link) == uncertain.end())
      uncertain.push_back(link);
  return true;
}

bool leave_out(std::span<const std::size_t> unknown, const Robot& robot, std::size_t camera_parent,
               RobotPose& pose) {
  if (!add_uncertain_links(robot, lost_joints(robot, unknown), camera_parent, pose.uncertain_links))
    return false;
  const std::vector<double> rest = robot.rest_positions();
  for (const std::size_t variable : unknown) pose.positions[variable] = rest[variable];
  pose.T_root_link.resize(robot.links().size());
  robot.forward_kinematics(pose.positions, pose.T_root_link);
  pose.positions.clear();
  return true;
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
    std::vector<std::string> names;
    for (auto gap = first; gap < end; ++gap) names.push_back(robot.variables()[gap->variable]);
    text += (text.empty() ? "joint" : "; joint") + std::string(names.size() > 1 ? "s " : " ") +
            some_of(names) + ": " + reason;
    first = end;
  }
  return text + describe_names(robot, joints);
}

std::string remedy_of(const Robot& robot, const JointAnswer& joints) {
  std::vector<std::size_t> missing;
  for (const JointGap& gap : joints.gaps)
    if (gap.why == JointStatus::missing) missing.push_back(gap.variable);
  if (missing.empty()) return {};
  std::vector<bool> is_moved = lost_joints(robot, missing);
  std::string links;
  for (std::size_t link = 1; link < is_moved.size(); ++link) {
    if (is_moved[robot.joints()[link - 1].parent]) is_moved[link] = true;
    if (is_moved[link] && robot.report()[link].drawn)
      links += (links.empty() ? "" : ",") + robot.links()[link];
  }
  if (links.empty()) return {};
  const auto can_be_held = [&](std::size_t variable) {
    return std::ranges::any_of(robot.joints(), [&](const Joint& joint) {
      return joint.variable == variable && !joint.mimics && variables_of(joint.type) == 1;
    });
  };
  const auto held = std::ranges::find_if(missing, can_be_held);
  return (held == missing.end() ? "; set "
                                : "; set joint " + robot.variables()[*held] + "=VALUE, or ") +
         ("ignore_links " + links);
}

}  // namespace penumbra
