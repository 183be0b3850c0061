// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/pipeline/pose_lookup.hpp>
#include <penumbra/pipeline/pose_stage-inl.hpp>

namespace penumbra {
namespace {

double distance_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const double turn =
      Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
  return std::max((a.translation() - b.translation()).norm(), Disagreement::lever * turn);
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

/// Values of a joint of its own, one after another.
std::size_t variables_of(JointType type) {
  if (type == JointType::planar) return 3;
  return type == JointType::floating ? 7 : 1;
}

std::string disagreement_text(const std::string& link, double distance, double agreement) {
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
  if (!(options_.agreement >= 0.0))
    throw InputError("agreement of joint states and TF is " + std::to_string(options_.agreement) +
                     " m; expected 0 or more");
  for (const std::string& link : robot.links()) frames_.push_back(options_.frame_prefix + link);
  note_movers();
}

/// Whether a variable that moves the link is meant.
template <typename F>
bool PoseLookup::any_variable_above(std::size_t link, const F& is_meant) const {
  for (std::size_t at = link; at > 0;) {
    const Joint& joint = robot_.joints()[at - 1];  // whose child it is
    for (std::size_t i = 0; joint.variable && i < variables_of(joint.type); ++i)
      if (is_meant(*joint.variable + i)) return true;
    at = joint.parent;
  }
  return false;
}

void PoseLookup::note_movers() {
  moves_.resize(robot_.variables().size());
  counts_.resize(frames_.size());
  for (std::size_t link = 0; link < frames_.size(); ++link) {
    counts_[link] = robot_.report()[link].drawn || link == camera_parent_;
    if (!counts_[link]) continue;
    static_cast<void>(any_variable_above(link, [this](std::size_t variable) {
      moves_[variable] = true;
      return false;
    }));
  }
  carries_ = counts_;
  for (std::size_t link = frames_.size() - 1; link > 0; --link)  // parents stand before children
    if (carries_[link]) carries_[robot_.joints()[link - 1].parent] = true;
}

void PoseLookup::at(const PoseHistory& history, std::int64_t stamp, PoseAnswer& answer) {
  answer.status = FrameStatus::ok;
  answer.message.clear();
  answer.age = 0;
  answer.T_parent_camera.reset();
  answer.disagreement.reset();
  answer.doubted_links.clear();
  answer.doubt.clear();
  const bool by_joints = options_.source != PoseSource::transforms;
  const bool by_transforms = options_.source != PoseSource::joints;
  answer.by_joints = by_joints;
  if (by_joints) find_joints(history, stamp, answer);
  if (by_transforms && has_pose(answer.status)) find_links(history.transforms(), stamp, answer);
  if (!options_.camera_frame.empty() && has_pose(answer.status))
    find_camera(history.transforms(), stamp, answer);
  if (by_joints && by_transforms && has_pose(answer.status)) compare(answer);
}

void PoseLookup::find_joints(const PoseHistory& history, std::int64_t stamp,
                             PoseAnswer& answer) const {
  history.joints().at(stamp, answer.joints);
  answer.age = answer.joints.age;
  if (answer.joints.status != JointStatus::ok) judge_unknown_joints(answer);
  answer.status = status_of(answer.joints.status);
  if (answer.status != FrameStatus::ok) answer.message = describe(robot_, answer.joints);
}

void PoseLookup::judge_unknown_joints(PoseAnswer& answer) const {
  JointStatus& status = answer.joints.status;
  auto& gaps = answer.joints.gaps;
  auto& disputes = answer.joints.disputes;
  const auto idle = std::not_fn([this](const auto& unknown) { return moves_[unknown.variable]; });
  if (!std::all_of(gaps.begin(), gaps.end(), idle) ||
      !std::all_of(disputes.begin(), disputes.end(), idle)) {
    std::erase_if(gaps, idle);
    std::erase_if(disputes, idle);
    status = gaps.empty() ? JointStatus::disputed : JointStatus::stale;
    for (const JointGap& gap : gaps)
      if (gap.why == JointStatus::missing) status = JointStatus::missing;
    return;
  }
  answer.doubt = describe(robot_, answer.joints);
  const auto is_unknown = [&](std::size_t variable) {
    const auto is_meant = [variable](const auto& unknown) { return unknown.variable == variable; };
    return std::any_of(gaps.begin(), gaps.end(), is_meant) ||
           std::any_of(disputes.begin(), disputes.end(), is_meant);
  };
  for (std::size_t link = 0; link < frames_.size(); ++link)
    if (any_variable_above(link, is_unknown)) answer.doubted_links.push_back(link);
  for (const JointGap& gap : gaps) answer.joints.positions[gap.variable] = rest_[gap.variable];
  status = JointStatus::ok;
  gaps.clear();
  disputes.clear();
}

void PoseLookup::find_links(const TransformBuffer& transforms, std::int64_t stamp,
                            PoseAnswer& answer) {
  answer.T_root_link.resize(frames_.size());
  answer.T_root_link[0].setIdentity();
  const auto is_doubted = [&](std::size_t link) {
    return std::count(answer.doubted_links.begin(), answer.doubted_links.end(), link) > 0;
  };
  for (const Joint& joint : robot_.joints()) {
    const bool is_given = joint.type != JointType::fixed || transforms.knows(frames_[joint.child]);
    const bool is_found = !is_given || find_transform(transforms, stamp, frames_[joint.parent],
                                                      frames_[joint.child], answer);
    if (!is_found && carries_[joint.child]) return;
    answer.T_root_link[joint.child] =
        answer.T_root_link[joint.parent] *
        (is_given && is_found ? transform_.T_target_source : joint.origin);
    if (!is_found) {
      answer.status = FrameStatus::ok;
      answer.doubt = std::exchange(answer.message, {});
    }
    if ((!is_found || is_doubted(joint.parent)) && !is_doubted(joint.child))
      answer.doubted_links.push_back(joint.child);
  }
}

void PoseLookup::find_camera(const TransformBuffer& transforms, std::int64_t stamp,
                             PoseAnswer& answer) {
  if (find_transform(transforms, stamp, frames_[camera_parent_], options_.camera_frame, answer))
    answer.T_parent_camera = transform_.T_target_source;
}

bool PoseLookup::find_transform(const TransformBuffer& transforms, std::int64_t stamp,
                                std::string_view target, std::string_view source,
                                PoseAnswer& answer) {
  transforms.at(stamp, target, source, transform_);
  answer.age = std::max(answer.age, transform_.age);
  if (transform_.status == TransformStatus::ok) return true;
  answer.status = status_of(transform_.status);
  answer.message = transform_.message;
  return false;
}

void PoseLookup::compare(PoseAnswer& answer) {
  robot_.forward_kinematics(answer.joints.positions, T_root_link_);
  Disagreement& most = answer.disagreement.emplace();
  Disagreement most_doubted;
  for (std::size_t i = 0; i < T_root_link_.size(); ++i) {
    const double distance = distance_between(T_root_link_[i], answer.T_root_link[i]);
    Disagreement& among = counts_[i] ? most : most_doubted;
    if (distance > among.distance) among = {i, distance};
    if (!counts_[i] && distance > options_.agreement) answer.doubted_links.push_back(i);
  }
  if (most.distance <= options_.agreement) {
    if (most_doubted.distance <= options_.agreement) return;
    answer.doubt += (answer.doubt.empty() ? "" : "; ") +
                    disagreement_text(robot_.links()[most_doubted.link], most_doubted.distance,
                                      options_.agreement);
    return;
  }
  answer.status = FrameStatus::poses_disagree;
  answer.message = disagreement_text(robot_.links()[most.link], most.distance, options_.agreement);
}

}  // namespace penumbra
