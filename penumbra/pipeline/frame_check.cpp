// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <variant>

#include <penumbra/pipeline/frame_check-inl.hpp>

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

/// The status that makes more of the frame unknown; the earlier one of two that make the same.
FrameStatus worse(FrameStatus a, FrameStatus b) {
  constexpr std::array order = {FrameStatus::missing_joints,    FrameStatus::stale_joints,
                                FrameStatus::missing_transform, FrameStatus::missing_depth,
                                FrameStatus::bad_depth,         FrameStatus::missing_link};
  for (const FrameStatus status : order)
    if (a == status || b == status) return status;
  return FrameStatus::ok;
}

}  // namespace

FrameCheck::FrameCheck(const Robot& robot, int width, int height,
                       std::span<const std::string> missing_links)
    : robot_(robot), width_(width), height_(height) {
  for (const std::string& link : missing_links)
    missing_links_ += (missing_links_.empty() ? "no geometry of link '" : ", '") + link + "'";
}

FrameStatus FrameCheck::operator()(const Frame& frame, std::string& message) const {
  message.clear();
  const FrameStatus source = check_source(frame, message);
  const FrameStatus joints =
      has_pose(source) ? check_joints(frame.joints, message) : FrameStatus::ok;
  const FrameStatus depth = has_depth(source) ? check_depth(frame, message) : FrameStatus::ok;
  const FrameStatus links = missing_links_.empty() ? FrameStatus::ok : FrameStatus::missing_link;
  if (!missing_links_.empty()) add_line(message, missing_links_);
  return worse(worse(source, joints), worse(depth, links));
}

FrameStatus FrameCheck::check_source(const Frame& frame, std::string& message) const {
  if (frame.source_status != FrameStatus::ok)
    add_line(message,
             frame.source_message.empty() ? to_string(frame.source_status) : frame.source_message);
  return frame.source_status;
}

FrameStatus FrameCheck::check_joints(const JointInput& joints, std::string& message) const {
  if (joints.status != JointStatus::ok) {
    add_line(message, describe(joints.gaps));
    return joints.status == JointStatus::stale ? FrameStatus::stale_joints
                                               : FrameStatus::missing_joints;
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

FrameStatus FrameCheck::check_depth(const Frame& frame, std::string& message) const {
  const auto [empty, width, height] =
      std::visit([](const auto& view) { return std::tuple(view.empty(), view.width, view.height); },
                 frame.depth);
  if (empty) {
    add_line(message, "no depth image");
    return FrameStatus::missing_depth;
  }
  if (width == width_ && height == height_) return FrameStatus::ok;
  add_line(message, "depth image is " + std::to_string(width) + "x" + std::to_string(height) +
                        ", the camera's images are " + std::to_string(width_) + "x" +
                        std::to_string(height_));
  return FrameStatus::bad_depth;
}

std::string FrameCheck::describe(std::span<const JointGap> gaps) const {
  if (gaps.empty()) return "no joint positions";
  std::string text;
  for (const JointGap& gap : gaps) {
    text += (text.empty() ? "" : ", ") + std::string("joint '") + robot_.variables()[gap.variable] +
            "' ";
    text += gap.why == JointStatus::stale ? "has no position near the stamp" : "was never seen";
    if (gap.last_seen) text += " (last seen at " + std::to_string(*gap.last_seen) + " ns)";
  }
  return text;
}

}  // namespace penumbra
