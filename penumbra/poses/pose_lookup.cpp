// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/poses/robot_pose.hpp>

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
      moves_needed_(robot.variables().size()),
      rest_(robot.rest_positions()),
      T_root_link_(robot.links().size()) {
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    frames_.push_back(options_.frame_prefix + robot.links()[link]);
    is_needed_.push_back(robot.report()[link].drawn || link == camera_parent_);
  }
  leads_to_needed_ = is_needed_;
  for (std::size_t link = frames_.size() - 1; link > 0; --link)
    if (leads_to_needed_[link]) leads_to_needed_[robot.joints()[link - 1].parent] = true;
  for (std::size_t variable = 0; variable < moves_needed_.size(); ++variable) {
    const std::vector<bool> moved = lost_joints(robot, {&variable, 1});
    for (std::size_t link = 0; link < moved.size(); ++link)
      if (moved[link] && leads_to_needed_[link]) moves_needed_[variable] = true;
  }
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
  if (by_joints && by_transforms && has_pose(pose.status)) compare(pose);
  const bool is_robot_known = has_pose(pose.status);
  if (!options_.camera_frame.empty() && is_robot_known)
    find_camera(history.transforms(), stamp, pose);
  pose.positions.clear();
  pose.T_root_link.clear();
  if (pose.status != FrameStatus::ok) pose.age.reset();
  if (!is_robot_known) return;
  if (by_joints && follows_from_joints_)
    pose.positions = joints_.positions;
  else
    pose.T_root_link = by_joints ? T_root_link_ : T_root_found_;
}

void PoseLookup::find_joints(const PoseHistory& history, std::int64_t stamp, RobotPose& pose) {
  history.joints().at(stamp, joints_);
  follows_from_joints_ = true;
  const bool is_in_tf = joints_.status != JointStatus::ok && is_moved_by_tf(history.transforms());
  const std::string by_tf = is_in_tf ? "; tf has its pose: set poses to tf" : "";
  if (joints_.status != JointStatus::ok) judge_unknown_joints(history.joints(), stamp, pose);
  pose.status = status_of(joints_.status);
  pose.age = joints_.age;
  if (pose.status != FrameStatus::ok) {
    pose.message = describe(robot_, joints_);
    pose.message += by_tf;
    return;
  }
  if (!pose.uncertain_reason.empty()) pose.uncertain_reason += by_tf;
  const bool has_mounts = !robot_.parts().empty() && history.transforms().knows(frames_[0]);
  if (has_mounts || !follows_from_joints_ || options_.source == PoseSource::both)
    robot_.forward_kinematics(joints_.positions, T_root_link_);
  if (has_mounts) find_mounts(history.transforms(), stamp, pose);
}

/// Returns whether TF has the pose of a floating or planar joint that was never seen.
bool PoseLookup::is_moved_by_tf(const TransformBuffer& transforms) const {
  return std::ranges::any_of(joints_.gaps, [&](const JointGap& gap) {
    return std::ranges::any_of(robot_.joints(), [&](const Joint& joint) {
      return gap.why == JointStatus::missing && joint.variable == gap.variable &&
             (joint.type == JointType::floating || joint.type == JointType::planar) &&
             transforms.knows(frames_[joint.child]);
    });
  });
}

/// Makes the links uncertain that unknown joints move, and the whole robot if one is disputed. If
/// that leaves no pose, only the joints that move a needed link stay unknown.
void PoseLookup::judge_unknown_joints(const JointBuffer& joints, std::int64_t stamp,
                                      RobotPose& pose) {
  auto& gaps = joints_.gaps;
  auto& disputes = joints_.disputes;
  std::vector<std::size_t> unknown, disputed;
  const auto take = [&](std::size_t variable, std::vector<std::size_t>& variables) {
    variables.push_back(variable);
    if (!moves_needed_[variable]) return;
    follows_from_joints_ = false;
    note_late(joints.newest_of({&robot_.variables()[variable], 1}), stamp);
  };
  for (const JointGap& gap : gaps) take(gap.variable, unknown);
  for (const JointDispute& dispute : disputes)
    take(dispute.variable, moves_needed_[dispute.variable] ? disputed : unknown);
  if (add_uncertain_links(robot_, lost_joints(robot_, unknown, disputed), camera_parent_,
                          pose.uncertain_links)) {
    pose.uncertain_reason = describe(robot_, joints_) + remedy_of(robot_, joints_);
    for (const JointGap& gap : gaps) joints_.positions[gap.variable] = rest_[gap.variable];
    joints_.status = JointStatus::ok;
    return;
  }
  const auto is_needed = [&](const auto& one) { return moves_needed_[one.variable]; };
  std::erase_if(gaps, std::not_fn(is_needed));
  std::erase_if(disputes, std::not_fn(is_needed));
  const bool is_missing = std::ranges::any_of(
      gaps, [](const JointGap& gap) { return gap.why == JointStatus::missing; });
  joints_.status = is_missing     ? JointStatus::missing
                   : gaps.empty() ? JointStatus::disputed
                                  : JointStatus::stale;
}

/// Notes that what is uncertain has no state after `newest`.
void PoseLookup::note_late(std::optional<std::int64_t> newest, std::int64_t stamp) {
  const std::int64_t since = newest.value_or(0);
  if (since < stamp) late_since_ = std::max(late_since_.value_or(since), since);
}

/// Moves the robots of a cell to where they stand by TF.
void PoseLookup::find_mounts(const TransformBuffer& transforms, std::int64_t stamp,
                             RobotPose& pose) {
  constexpr double rounding = 1e-9;
  forget_lost();
  for (const RobotPart& part : robot_.parts()) {
    const Joint& mount = robot_.joints()[part.first_link - 1];
    if (!find_joint(transforms, stamp, mount, pose)) continue;
    const Eigen::Isometry3d moved = transform_.T_target_source * mount.origin.inverse();
    if (moved.isApprox(Eigen::Isometry3d::Identity(), rounding)) continue;
    follows_from_joints_ = false;
    for (std::size_t link = part.first_link; link < part.end_link; ++link)
      T_root_link_[link] = moved * T_root_link_[link];
  }
  settle_lost(pose);
}

void PoseLookup::find_links(const TransformBuffer& transforms, std::int64_t stamp,
                            RobotPose& pose) {
  T_root_found_.resize(frames_.size());
  T_root_found_[0].setIdentity();
  forget_lost();
  for (const Joint& joint : robot_.joints()) {
    const bool is_mount = joint.parent == 0 && robot_.part_of(joint.child) != nullptr;
    const bool is_given =
        joint.type != JointType::fixed || transforms.knows(frames_[is_mount ? 0 : joint.child]);
    const bool is_found = is_given && find_joint(transforms, stamp, joint, pose);
    T_root_found_[joint.child] =
        T_root_found_[joint.parent] * (is_found ? transform_.T_target_source : joint.origin);
  }
  settle_lost(pose);
}

void PoseLookup::forget_lost() {
  lost_.is_lost.assign(frames_.size(), false);
  lost_.status = FrameStatus::ok;
  lost_.is_needed = false;
}

/// Looks up the pose of a joint's child link. Returns false and notes the joint as lost if TF lacks
/// it.
bool PoseLookup::find_joint(const TransformBuffer& transforms, std::int64_t stamp,
                            const Joint& joint, RobotPose& pose) {
  if (find_transform(transforms, stamp, frames_[joint.parent], frames_[joint.child], pose))
    return true;
  const bool is_needed = leads_to_needed_[joint.child];
  if (is_needed) note_late(transforms.newest_of(frames_[joint.child]), stamp);
  std::size_t from = joint.child;  // what is lost
  if (is_needed && pose.status == FrameStatus::poses_disagree) from = root_of(joint.child);
  if (joint.parent == 0 && robot_.part_of(joint.child) != nullptr) from = 0;  // it may be anywhere
  lost_.is_lost[from] = true;
  const FrameStatus status = std::exchange(pose.status, FrameStatus::ok);
  const std::string message = std::exchange(pose.message, {});
  if (lost_.status == FrameStatus::ok || (is_needed && !lost_.is_needed))
    lost_.status = status, lost_.message = message, lost_.is_needed = is_needed;
  return false;
}

/// Makes the links uncertain that lost joints move, or the pose unknown.
void PoseLookup::settle_lost(RobotPose& pose) {
  if (lost_.status == FrameStatus::ok) return;
  if (add_uncertain_links(robot_, lost_.is_lost, camera_parent_, pose.uncertain_links)) {
    add_part(pose.uncertain_reason, lost_.message);
  } else {
    pose.status = lost_.status;
    pose.message = lost_.message;
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

/// Returns the first link of a link's robot.
std::size_t PoseLookup::root_of(std::size_t link) const {
  const RobotPart* const part = robot_.part_of(link);
  return part == nullptr ? 0 : part->first_link;
}

void PoseLookup::compare(RobotPose& pose) {
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
  if (needed.distance > agreement) {
    forget_lost();
    lost_.is_lost[root_of(needed.link)] = true;
    lost_.status = FrameStatus::poses_disagree;
    lost_.message = text(needed);
    settle_lost(pose);
    if (has_pose(pose.status)) compare(pose);  // the other robots
  } else if (other.distance > agreement) {
    add_part(pose.uncertain_reason, text(other));
  }
}

}  // namespace penumbra
