// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/pipeline/frame_check-inl.hpp>
#include <penumbra/targets/extent_tally-inl.hpp>

namespace penumbra {
namespace {

void add_line(std::string& message, std::string_view part) {
  if (!message.empty()) message += "; ";
  message += part;
}

/// What Robot::forward_kinematics takes, rad and m.
constexpr double largest_position = 1e9;

/// A quaternion's length may be off 1 by rounding in a file, not by a wrong value.
constexpr double quaternion_error = 0.01;

bool is_rotation(std::span<const double> q) {
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  return std::abs(length - 1.0) <= quaternion_error;
}

template <typename T>
bool holds_measurement(ImageView<const T> depth, const labelling::Rule& rule) {
  const Measured measured(depth, rule);
  for (int v = 0; v < depth.height; ++v) {
    const auto row = measured.row(v);
    std::int32_t count = 0;  // whole rows, without branches: so the compiler takes vectors
    for (int u = 0; u < depth.width; ++u) count += row.is_measured(u) ? 1 : 0;
    if (count > 0) return true;
  }
  return false;
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

/// The status that makes more of the frame unknown; the earlier one of two that make the same.
FrameStatus worse(FrameStatus a, FrameStatus b) {
  constexpr std::array order = {FrameStatus::missing_joints,    FrameStatus::stale_joints,
                                FrameStatus::missing_transform, FrameStatus::stale_transform,
                                FrameStatus::poses_disagree,    FrameStatus::missing_depth,
                                FrameStatus::bad_depth,         FrameStatus::missing_link};
  for (const FrameStatus status : order)
    if (a == status || b == status) return status;
  return FrameStatus::ok;
}

}  // namespace

FrameCheck::FrameCheck(const Robot& robot, int width, int height, const LabelRule& rule,
                       std::span<const std::string> missing_links)
    : robot_(robot), width_(width), height_(height), range_(rule.range), rule_(rule) {
  for (const std::string& link : missing_links)
    missing_links_ += (missing_links_.empty() ? "no geometry of link '" : ", '") + link + "'";
}

void FrameCheck::operator()(const Frame& frame, FrameReport& report) const {
  std::string& message = report.message;
  message.clear();
  report.nothing_measured = false;
  check_doubts(frame.doubts);
  const FrameStatus source = check_source(frame, message);
  const FrameStatus poses = has_pose(source) ? check_poses(frame, message) : FrameStatus::ok;
  const FrameStatus depth = has_depth(source) ? check_depth(frame, report) : FrameStatus::ok;
  const FrameStatus links = missing_links_.empty() ? FrameStatus::ok : FrameStatus::missing_link;
  if (!missing_links_.empty()) add_line(message, missing_links_);
  report.status = worse(worse(source, poses), worse(depth, links));
}

/// No frame's fault: whoever made it counts other links.
void FrameCheck::check_doubts(const LinkDoubts& doubts) const {
  const std::size_t count = robot_.links().size();
  for (const std::size_t link : doubts.links)
    if (link >= count)
      throw InputError("doubted link " + std::to_string(link) + " is none of robot '" +
                       robot_.name() + "': expected an index below " + std::to_string(count));
}

FrameStatus FrameCheck::check_source(const Frame& frame, std::string& message) const {
  if (frame.source_status != FrameStatus::ok)
    add_line(message,
             frame.source_message.empty() ? to_string(frame.source_status) : frame.source_message);
  return frame.source_status;
}

FrameStatus FrameCheck::check_poses(const Frame& frame, std::string& message) const {
  const FrameStatus links = frame.T_root_link.empty() ? check_joints(frame.joints, message)
                                                      : check_links(frame.T_root_link, message);
  if (!frame.T_parent_camera || is_rigid(*frame.T_parent_camera)) return links;
  add_line(message, "the camera's pose is no rigid transform");
  return worse(links, FrameStatus::missing_transform);
}

FrameStatus FrameCheck::check_links(std::span<const Eigen::Isometry3d> T_root_link,
                                    std::string& message) const {
  const auto links = robot_.links();
  if (T_root_link.size() != links.size()) {
    add_line(message, std::to_string(T_root_link.size()) + " poses for " +
                          std::to_string(links.size()) + " links");
    return FrameStatus::missing_transform;
  }
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool at_root = i > 0 || T_root_link[0].isApprox(Eigen::Isometry3d::Identity(), rounding);
    if (is_rigid(T_root_link[i]) && at_root) continue;
    add_line(message, "pose of link '" + links[i] + "' is no rigid transform" +
                          (i > 0 ? "" : ", or not the identity though it is the root"));
    return FrameStatus::missing_transform;
  }
  return FrameStatus::ok;
}

FrameStatus FrameCheck::check_joints(const JointInput& joints, std::string& message) const {
  if (joints.status != JointStatus::ok) {
    add_line(message, describe(robot_, joints));
    return status_of(joints.status);
  }
  const auto variables = robot_.variables();
  if (joints.positions.size() != variables.size()) {
    add_line(message, std::to_string(joints.positions.size()) + " joint positions for " +
                          std::to_string(variables.size()) + " joint variables");
    return FrameStatus::missing_joints;
  }
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (std::abs(joints.positions[i]) <= largest_position) continue;  // false for NaN
    add_line(message, "position of joint '" + variables[i] + "' is not a number within +-1e9");
    return FrameStatus::missing_joints;
  }
  for (const Joint& joint : robot_.joints()) {
    if (joint.type != JointType::floating) continue;
    if (is_rotation(joints.positions.subspan(*joint.variable + 3, 4))) continue;
    add_line(message, "quaternion of joint '" + joint.name + "' has not the length 1");
    return FrameStatus::missing_joints;
  }
  return FrameStatus::ok;
}

FrameStatus FrameCheck::check_depth(const Frame& frame, FrameReport& report) const {
  std::string& message = report.message;
  const auto [empty, width, height] =
      std::visit([](const auto& view) { return std::tuple(view.empty(), view.width, view.height); },
                 frame.depth);
  if (empty) {
    add_line(message, "no depth image");
    return FrameStatus::missing_depth;
  }
  if (width != width_ || height != height_) {
    add_line(message, "depth image is " + std::to_string(width) + "x" + std::to_string(height) +
                          ", the camera's images are " + std::to_string(width_) + "x" +
                          std::to_string(height_));
    return FrameStatus::bad_depth;
  }
  report.nothing_measured =
      !std::visit([&](const auto& view) { return holds_measurement(view, rule_); }, frame.depth);
  if (!report.nothing_measured) return FrameStatus::ok;
  add_line(message, without_measurement());
  return FrameStatus::bad_depth;
}

std::string FrameCheck::without_measurement() const {
  std::ostringstream text;
  text << "no pixel of the depth image holds a measurement";
  if (range_.near > 0.0 || std::isfinite(range_.far))
    text << " within " << range_.near << " to " << range_.far << " m";
  return text.str();
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

std::string describe(const Robot& robot, const JointInput& joints) {
  if (joints.status == JointStatus::disputed) return describe_disputes(robot, joints.disputes);
  if (joints.gaps.empty()) return "no joint positions";
  std::string text;
  for (const JointGap& gap : joints.gaps) {
    text += (text.empty() ? "" : ", ") + std::string("joint '") + robot.variables()[gap.variable] +
            "' ";
    if (gap.jump) {
      text += "jumps by " + std::to_string(*gap.jump) + " next to the stamp, more than it can move";
      continue;
    }
    text += gap.why == JointStatus::stale ? "has no position near the stamp" : "was never seen";
    if (!gap.last_seen) continue;
    text += " (last seen at " + std::to_string(*gap.last_seen) + " ns";
    if (!gap.source.empty()) text += " by " + gap.source + std::string(others_unused);
    text += ")";
  }
  return text;
}

}  // namespace penumbra
