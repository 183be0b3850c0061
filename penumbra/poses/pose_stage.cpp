// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <limits>
#include <sstream>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/poses/pose_stage.hpp>

namespace penumbra {
namespace {

/// Allows for the rounding of quaternions in files.
constexpr double quaternion_error = 0.01;

bool is_rotation(std::span<const double> q) {
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  return std::abs(length - 1.0) <= quaternion_error;
}

}  // namespace

std::vector<std::string> missing_links_of(const Robot& robot) {
  std::vector<std::string> links;
  for (const LinkReport& link : robot.report())
    if (link.missing) links.push_back(link.link);
  return links;
}

void add_part(std::string& line, std::string_view part) {
  if (!line.empty()) line += "; ";
  line += part;
}

PoseStage::PoseStage(const Robot& robot, const std::string& camera_parent,
                     const Eigen::Isometry3d& T_parent_camera,
                     std::span<const std::string> missing_links, bool is_camera)
    : robot_(robot),
      missing_links_(missing_links.begin(), missing_links.end()),
      links_(robot.links().begin(), robot.links().end()),
      parent_(find_camera_parent(robot, camera_parent)),
      camera_inside_(is_camera ? bodies_of(robot) : std::vector<Body>()),
      reach_(reach_of_links(robot)) {
  links_.reserve(links_.size() + max_attached);
  result_.T_root_link.resize(robot.links().size());
  result_.T_camera_link.resize(robot.links().size());
  if (!is_rigid(T_parent_camera))
    throw InputError(
        "camera pose is not a rigid transform: expected a rotation (orthonormal, determinant 1) "
        "and a finite translation in metres");
  if (T_parent_camera.translation().cwiseAbs().maxCoeff() > max_distance)
    throw InputError("camera pose is more than 1000 km from its parent link; expected metres");
  T_camera_parent_ = T_parent_camera.inverse();
  for (const LinkReport& link : robot.report())
    if (link.drawn) length_ += link.bounds.sizes().norm();
  for (const std::string& link : missing_links)
    without_links_ += (without_links_.empty() ? "no geometry of link '" : ", '") + link + "'";
}

const PoseResult& PoseStage::place(const RobotPose& pose, std::optional<std::int64_t> stamp,
                                   FrameStatus given_status, std::string_view message) {
  const StageTimer timer(result_.kinematics_ms);
  check_uncertain(pose.uncertain_links);
  result_.stamp = stamp;
  result_.message.clear();
  result_.note.clear();
  result_.uncertain_links = pose.uncertain_links;
  result_.uncertain_reason = pose.uncertain_reason;
  FrameStatus& status = result_.status;
  status = worse(given(pose.status, pose.message), given(given_status, message));
  if (has_pose(status)) status = worse(status, check_poses(pose));
  result_.missing_links = missing_links_;
  if (!missing_links_.empty())
    status = worse(status, fault(FrameStatus::missing_link, without_links_));
  if (has_pose(status)) status = worse(status, place_links(pose));
  result_.attached.clear();
  result_.reaches.clear();
  if (has_pose(status)) status = worse(status, place_uncertain());
  if (has_pose(status)) status = worse(status, place_bodies(pose.attached));
  if (has_pose(status)) take_out_uncertain();
  result_.links = links_;
  return result_;
}

/// Throws because an index out of range is an error of the caller, not a fault of the frame.
void PoseStage::check_uncertain(std::span<const std::size_t> links) const {
  const std::size_t count = robot_.links().size();
  for (const std::size_t link : links)
    if (link >= count)
      throw InputError("uncertain link " + std::to_string(link) + " is not a link of robot '" +
                       robot_.name() + "': expected an index below " + std::to_string(count));
}

FrameStatus PoseStage::fault(FrameStatus status, std::string_view message) {
  add_part(result_.message, message);
  return status;
}

/// Adds a fault that the frame came with.
FrameStatus PoseStage::given(FrameStatus status, std::string_view message) {
  if (status != FrameStatus::ok) fault(status, message.empty() ? to_string(status) : message);
  return status;
}

FrameStatus PoseStage::check_poses(const RobotPose& pose) {
  const FrameStatus links =
      pose.T_root_link.empty() ? check_joints(pose.positions) : check_links(pose.T_root_link);
  if (!pose.T_parent_camera || is_rigid(*pose.T_parent_camera)) return links;
  return worse(links,
               fault(FrameStatus::missing_transform, "the camera's pose is not a rigid transform"));
}

FrameStatus PoseStage::check_links(std::span<const Eigen::Isometry3d> T_root_link) {
  const auto links = robot_.links();
  if (T_root_link.size() != links.size())
    return fault(FrameStatus::missing_transform, std::to_string(T_root_link.size()) +
                                                     " poses for " + std::to_string(links.size()) +
                                                     " links");
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool at_root = i > 0 || T_root_link[0].isApprox(Eigen::Isometry3d::Identity(), rounding);
    if (is_rigid(T_root_link[i]) && at_root) continue;
    return fault(FrameStatus::missing_transform,
                 "pose of link '" + links[i] + "' is not a rigid transform" +
                     (i > 0 ? "" : ", or not the identity although it is the root"));
  }
  return FrameStatus::ok;
}

FrameStatus PoseStage::check_joints(std::span<const double> positions) {
  const auto variables = robot_.variables();
  if (positions.size() != variables.size())
    return fault(FrameStatus::missing_joints,
                 (positions.empty() ? "no" : std::to_string(positions.size())) +
                     " joint positions for " + std::to_string(variables.size()) +
                     " joint variables");
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (std::abs(positions[i]) <= Robot::max_position) continue;  // false for NaN
    return fault(FrameStatus::missing_joints,
                 "position of joint '" + variables[i] + "' is not a number within +-1e9");
  }
  for (const Joint& joint : robot_.joints()) {
    if (joint.type != JointType::floating) continue;
    if (is_rotation(positions.subspan(*joint.variable + 3, 4))) continue;
    return fault(FrameStatus::missing_joints,
                 "quaternion of joint '" + joint.name + "' does not have length 1");
  }
  return FrameStatus::ok;
}

FrameStatus PoseStage::place_links(const RobotPose& pose) {
  auto& T_root_link = result_.T_root_link;
  auto& T_camera_link = result_.T_camera_link;
  if (pose.T_root_link.empty())
    robot_.forward_kinematics(pose.positions, T_root_link);
  else
    std::copy(pose.T_root_link.begin(), pose.T_root_link.end(), T_root_link.begin());
  const Eigen::Isometry3d T_camera_parent =
      pose.T_parent_camera ? pose.T_parent_camera->inverse() : T_camera_parent_;
  const Eigen::Isometry3d T_camera_root = T_camera_parent * T_root_link[parent_].inverse();
  result_.T_root_camera = T_camera_root.inverse();
  for (std::size_t i = 0; i < T_root_link.size(); ++i) {
    T_camera_link[i] = T_camera_root * T_root_link[i];
    if (T_camera_link[i].translation().cwiseAbs().maxCoeff() <= max_distance &&
        T_camera_link[i].matrix().allFinite())
      continue;
    const bool by_joints = pose.T_root_link.empty() && !pose.T_parent_camera;
    return fault(by_joints ? FrameStatus::missing_joints : FrameStatus::missing_transform,
                 (by_joints ? "joint positions put link '" : "poses put link '") +
                     robot_.links()[i] + "' more than 1000 km from the camera");
  }
  if (const auto link = camera_inside_.find(T_camera_link))
    return fault(FrameStatus::missing_transform,
                 "the camera's centre lies inside link '" + robot_.links()[*link] +
                     "': correct the camera's pose, or name the link in ignore_links if it is the "
                     "camera's own housing");
  return FrameStatus::ok;
}

/// Finds what links of unknown pose could reach.
FrameStatus PoseStage::place_uncertain() {
  if (result_.is_uncertain(parent_))
    return fault(FrameStatus::missing_transform,
                 "the pose of link '" + robot_.links()[parent_] +
                     "', which carries the camera, is not known: " + result_.uncertain_reason);
  for (const std::size_t link : result_.uncertain_links) {
    const bool is_first = link == 0 || !result_.is_uncertain(robot_.joints()[link - 1].parent);
    if (is_first && reach_[link].radius >= 0.0) add_reach(link, reach_[link]);
  }
  if (result_.reaches.empty()) return FrameStatus::ok;
  const bool is_one = result_.reaches.size() == 1;
  std::string names;
  for (const Reach& reach : result_.reaches)
    names += (names.empty() ? "'" : ", '") + robot_.links()[reach.link] + "'";
  return fault(FrameStatus::missing_link,
               (is_one ? "link " : "links ") + names + (is_one ? " is" : " are") +
                   " not drawn, and what " + (is_one ? "it" : "they") +
                   " could hide is unknown: " + result_.uncertain_reason);
}

/// Takes links of unknown pose out of the picture.
void PoseStage::take_out_uncertain() {
  for (const std::size_t link : result_.uncertain_links) {
    if (!robot_.report()[link].drawn) continue;
    result_.T_root_link[link].matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
    result_.T_camera_link[link] = Eigen::Translation3d(0.0, 0.0, -max_distance);  // not in view
  }
}

/// Adds where a ball of a link can be to the reach of the first link of unknown pose above it.
void PoseStage::add_reach(std::size_t link, Ball ball) {
  const auto parent = [&] { return robot_.joints()[link - 1].parent; };
  while (link > 0 && result_.is_uncertain(parent())) {
    ball = swept(robot_.joints()[link - 1], ball);
    link = parent();
  }
  if (link == 0)
    ball.radius = std::numeric_limits<double>::infinity();
  else if (robot_.joints()[link - 1].type == JointType::fixed)  // its pose may be TF's
    ball = transformed(result_.T_camera_link[link], ball);
  else
    ball = transformed(result_.T_camera_link[parent()], swept(robot_.joints()[link - 1], ball));
  for (Reach& reach : result_.reaches)
    if (reach.link == link) {
      reach.ball = ball_around(reach.ball, ball);
      return;
    }
  result_.reaches.push_back({link, ball});
}

FrameStatus PoseStage::place_bodies(std::span<const AttachedBody> bodies) {
  ++frames_;
  FrameStatus status = FrameStatus::ok;
  for (const AttachedBody& body : bodies) status = worse(status, place_body(body));
  return status;
}

FrameStatus PoseStage::place_body(const AttachedBody& body) {
  const auto missing = [&](const std::string& why) {
    result_.missing_links.push_back(body.name);
    return fault(FrameStatus::missing_link,
                 "attached body '" + body.name + "' is not drawn: " + why);
  };
  const auto link = robot_.find_link(body.link);
  if (!link) return missing("there is no link '" + body.link + "'");
  if (!body.mesh || body.mesh->triangles.empty())
    return missing(body.reason.empty() ? "it has no triangles" : body.reason);
  if (!is_rigid(body.T_link_body)) return missing("its pose is not a rigid transform");
  note_size(body);
  if (result_.attached.size() == max_attached)
    return missing("more than " + std::to_string(max_attached) + " bodies are attached");
  if (result_.is_uncertain(*link)) {
    const Eigen::AlignedBox3d& box = body.mesh->bounds;
    add_reach(*link, transformed(body.T_link_body, {box.center(), 0.5 * box.diagonal().norm()}));
    return fault(FrameStatus::missing_link, "attached body '" + body.name +
                                                "' is not drawn: the pose of link '" + body.link +
                                                "' is not known");
  }
  result_.attached.push_back({number_of(body.name), body.name, body.link, body.mesh,
                              result_.T_camera_link[*link] * body.T_link_body});
  return FrameStatus::ok;
}

/// A robot carries nothing that is several times as long as itself.
void PoseStage::note_size(const AttachedBody& body) {
  constexpr double least = 3.0, times = 3.0;  // metres; of the robot's length
  const Eigen::AlignedBox3d& box = body.mesh->bounds;
  const double reach = (body.T_link_body * box.center()).norm() + 0.5 * box.diagonal().norm();
  if (!result_.note.empty() || reach < std::max(least, times * length_)) return;
  std::ostringstream line;
  line << std::setprecision(3) << "attached body '" << body.name << "' reaches " << reach
       << " m from link '" << body.link << "', and the links of the robot are " << length_
       << " m long together: is it in millimetres? give metres";
  result_.note = line.str();
}

/// Returns the index of a body in links_. A new body takes the place of the one that was attached
/// the longest time ago if all places are taken.
std::size_t PoseStage::number_of(const std::string& body) {
  const auto first = links_.begin() + static_cast<std::ptrdiff_t>(robot_.links().size());
  auto place = std::find(first, links_.end(), body);
  if (place == links_.end() && last_use_.size() < max_attached) {
    last_use_.push_back(0);
    links_.push_back(body);
    place = std::prev(links_.end());
  } else if (place == links_.end()) {
    place = first + (std::min_element(last_use_.begin(), last_use_.end()) - last_use_.begin());
    *place = body;
  }
  const auto number = static_cast<std::size_t>(place - links_.begin());
  last_use_[number - robot_.links().size()] = frames_;
  return number;
}

}  // namespace penumbra
