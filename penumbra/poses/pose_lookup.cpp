// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/poses/pose_lookup.hpp>
#include <penumbra/poses/pose_stage-inl.hpp>

namespace penumbra {
namespace {

constexpr double agreement = 0.005;  // metres between a link's poses by joint states and by TF
constexpr double arc_radius = 0.5;   // metres at which a rotation counts as an arc

double distance_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const double turn =
      Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
  return std::max((a.translation() - b.translation()).norm(), arc_radius * turn);
}

FrameStatus status_of(TransformStatus transform) {
  switch (transform) {
    case TransformStatus::ok:
      return FrameStatus::ok;
    case TransformStatus::stale:
      return FrameStatus::stale_transform;
    case TransformStatus::disputed:
      return FrameStatus::poses_disagree;
    case TransformStatus::missing:
      break;
  }
  return FrameStatus::missing_transform;
}

/// Returns the number of a joint's variables, which are consecutive.
std::size_t variables_of(JointType type) {
  if (type == JointType::planar) return 3;
  return type == JointType::floating ? 7 : 1;
}

bool holds(const std::vector<std::size_t>& indices, std::size_t index) {
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

void add_to(std::vector<std::size_t>& indices, std::size_t index) {
  if (!holds(indices, index)) indices.push_back(index);
}

std::string disagreement_text(const std::string& link, double distance) {
  std::ostringstream text;
  text.precision(3);
  text << "joint states and TF put link '" << link << "' " << 1e3 * distance
       << " mm apart, more than " << 1e3 * agreement << " mm";
  return text.str();
}

}  // namespace

std::string_view to_string(PoseSource source) {
  switch (source) {
    case PoseSource::joints:
      return "joints";
    case PoseSource::transforms:
      return "tf";
    case PoseSource::both:
      return "both";
  }
  return "";
}

PoseLookup::PoseLookup(const Robot& robot, PoseOptions options)
    : robot_(robot),
      options_(std::move(options)),
      camera_parent_(find_camera_parent(robot, options_.camera_parent)),
      rest_(robot.rest_positions()),
      T_root_link_(robot.links().size()) {
  moves_needed_.resize(robot.variables().size());
  variable_links_.resize(robot.variables().size());
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    frames_.push_back(options_.frame_prefix + robot.links()[link]);
    auto& movers = movers_.emplace_back();
    if (link > 0) {
      const Joint& joint = robot.joints()[link - 1];  // parents come before children
      movers = movers_[joint.parent];
      for (std::size_t i = 0; joint.variable && i < variables_of(joint.type); ++i)
        movers.push_back(*joint.variable + i);
      for (const std::size_t variable : movers) variable_links_[variable] = link;
    }
    is_needed_.push_back(robot.report()[link].drawn || link == camera_parent_);
    if (!is_needed_[link]) continue;
    for (const std::size_t variable : movers) moves_needed_[variable] = true;
  }
  leads_to_needed_ = is_needed_;
  for (std::size_t link = frames_.size() - 1; link > 0; --link)
    if (leads_to_needed_[link]) leads_to_needed_[robot.joints()[link - 1].parent] = true;
}

void PoseLookup::at(const PoseHistory& history, std::int64_t stamp, RobotPose& pose) {
  pose.status = FrameStatus::ok;
  pose.message.clear();
  pose.age = 0;
  pose.T_parent_camera.reset();
  pose.uncertain_links.clear();
  pose.uncertain_reason.clear();
  late_since_.reset();
  history.attachments().at(stamp, pose.attached);
  const bool by_joints = options_.source != PoseSource::transforms;
  const bool by_transforms = options_.source != PoseSource::joints;
  if (by_joints) find_joints(history, stamp, pose);
  if (by_transforms && has_pose(pose.status)) find_links(history.transforms(), stamp, pose);
  if (!options_.camera_frame.empty() && has_pose(pose.status))
    find_camera(history.transforms(), stamp, pose);
  if (by_joints && by_transforms && has_pose(pose.status)) compare(pose);
  pose.positions.clear();
  pose.T_root_link.clear();
  if (pose.status != FrameStatus::ok)
    pose.age.reset();
  else if (by_joints)
    pose.positions = joints_.positions;
  else
    pose.T_root_link = T_root_found_;
}

void PoseLookup::find_joints(const PoseHistory& history, std::int64_t stamp, RobotPose& pose) {
  history.joints().at(stamp, joints_);
  if (joints_.status != JointStatus::ok) judge_unknown_joints(history.joints(), stamp, pose);
  pose.status = status_of(joints_.status);
  pose.age = joints_.age;
  if (pose.status != FrameStatus::ok) pose.message = describe(robot_, joints_);
}

/// Keeps the unknown joints that move a needed link. Without any, the answer is ok and the links
/// that the others move are uncertain.
void PoseLookup::judge_unknown_joints(const JointBuffer& joints, std::int64_t stamp,
                                      RobotPose& pose) {
  JointStatus& status = joints_.status;
  auto& gaps = joints_.gaps;
  auto& disputes = joints_.disputes;
  const auto mark = [&](const auto& all) {
    for (const auto& unknown : all)
      if (moves_needed_[unknown.variable] &&
          mark_robot_uncertain(variable_links_[unknown.variable], pose))
        note_uncertain_robot(joints.newest_of({&robot_.variables()[unknown.variable], 1}), stamp);
  };
  mark(gaps);
  mark(disputes);
  const auto is_needed = [&](const auto& unknown) {
    return moves_needed_[unknown.variable] &&
           !holds(pose.uncertain_links, variable_links_[unknown.variable]);
  };
  if (std::any_of(gaps.begin(), gaps.end(), is_needed) ||
      std::any_of(disputes.begin(), disputes.end(), is_needed)) {
    std::erase_if(gaps, std::not_fn(is_needed));
    std::erase_if(disputes, std::not_fn(is_needed));
    status = gaps.empty() ? JointStatus::disputed : JointStatus::stale;
    for (const JointGap& gap : gaps)
      if (gap.why == JointStatus::missing) status = JointStatus::missing;
    return;
  }
  pose.uncertain_reason = describe(robot_, joints_);
  for (std::size_t link = 0; link < frames_.size(); ++link) {
    const auto moves_link = [&](const auto& unknown) {
      return holds(movers_[link], unknown.variable);
    };
    if (std::any_of(gaps.begin(), gaps.end(), moves_link) ||
        std::any_of(disputes.begin(), disputes.end(), moves_link))
      add_to(pose.uncertain_links, link);
  }
  for (const JointGap& gap : gaps) joints_.positions[gap.variable] = rest_[gap.variable];
  status = JointStatus::ok;
  gaps.clear();
  disputes.clear();
}

/// Notes that a robot is uncertain whose newest state is `newest`.
void PoseLookup::note_uncertain_robot(std::optional<std::int64_t> newest, std::int64_t stamp) {
  const std::int64_t since = newest.value_or(0);
  if (since < stamp) late_since_ = std::max(late_since_.value_or(since), since);
}

void PoseLookup::find_links(const TransformBuffer& transforms, std::int64_t stamp,
                            RobotPose& pose) {
  T_root_found_.resize(frames_.size());
  T_root_found_[0].setIdentity();
  auto& uncertain = pose.uncertain_links;
  for (const Joint& joint : robot_.joints()) {
    const bool is_mount = joint.parent == 0 && robot_.part_of(joint.child) != nullptr;
    const bool is_given =
        joint.type != JointType::fixed || transforms.knows(frames_[is_mount ? 0 : joint.child]);
    const bool is_found = !is_given || find_transform(transforms, stamp, frames_[joint.parent],
                                                      frames_[joint.child], pose);
    if (!is_found && leads_to_needed_[joint.child]) {
      if (!mark_robot_uncertain(joint.child, pose)) return;
      note_uncertain_robot(transforms.newest_of(frames_[joint.child]), stamp);
    }
    T_root_found_[joint.child] = T_root_found_[joint.parent] *
                                 (is_given && is_found ? transform_.T_target_source : joint.origin);
    if (!is_found) {
      pose.status = FrameStatus::ok;
      pose.uncertain_reason = std::exchange(pose.message, {});
    }
    if (!is_found || holds(uncertain, joint.parent)) add_to(uncertain, joint.child);
  }
}

void PoseLookup::find_camera(const TransformBuffer& transforms, std::int64_t stamp,
                             RobotPose& pose) {
  if (find_transform(transforms, stamp, frames_[camera_parent_], options_.camera_frame, pose))
    pose.T_parent_camera = transform_.T_target_source;
}

bool PoseLookup::find_transform(const TransformBuffer& transforms, std::int64_t stamp,
                                std::string_view target, std::string_view source, RobotPose& pose) {
  transforms.at(stamp, target, source, transform_);
  pose.age = std::max(*pose.age, transform_.age);
  if (transform_.status == TransformStatus::ok) return true;
  pose.status = status_of(transform_.status);
  pose.message = transform_.message;
  return false;
}

/// Makes all links of a link's robot uncertain. Returns false if the frame cannot do without that
/// robot: it is the only one, or carries the camera.
bool PoseLookup::mark_robot_uncertain(std::size_t link, RobotPose& pose) const {
  const RobotPart* const part = robot_.part_of(link);
  if (part == nullptr || part == robot_.part_of(camera_parent_)) return false;
  for (std::size_t i = part->first_link; i < part->end_link; ++i) add_to(pose.uncertain_links, i);
  return true;
}

void PoseLookup::compare(RobotPose& pose) {
  robot_.forward_kinematics(joints_.positions, T_root_link_);
  struct Disagreement {
    std::size_t link = 0;
    double distance = 0.0;
  };
  Disagreement needed, other;
  for (std::size_t i = 0; i < T_root_link_.size(); ++i) {
    if (holds(pose.uncertain_links, i)) continue;
    const double distance = distance_between(T_root_link_[i], T_root_found_[i]);
    Disagreement& most = is_needed_[i] ? needed : other;
    if (distance > most.distance) most = {i, distance};
    if (!is_needed_[i] && distance > agreement) add_to(pose.uncertain_links, i);
  }
  const auto text = [&](const Disagreement& most) {
    return disagreement_text(robot_.links()[most.link], most.distance);
  };
  if (needed.distance > agreement && mark_robot_uncertain(needed.link, pose)) {
    add_part(pose.uncertain_reason, text(needed));
    compare(pose);  // the other robots
  } else if (needed.distance > agreement) {
    pose.status = FrameStatus::poses_disagree;
    pose.message = text(needed);
  } else if (other.distance > agreement) {
    add_part(pose.uncertain_reason, text(other));
  }
}

}  // namespace penumbra
