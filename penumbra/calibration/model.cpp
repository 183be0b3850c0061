// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <penumbra/calibration/dense.hpp>
#include <penumbra/calibration/problem.hpp>

namespace penumbra::calibration {

Eigen::Isometry3d motion(const Twist& twist) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const double angle = twist.head<3>().norm();
  if (angle > 0.0) T.linear() = Eigen::AngleAxisd(angle, twist.head<3>() / angle).matrix();
  T.translation() = twist.tail<3>();
  return T;
}

Twist twist_of(const Eigen::Isometry3d& motion) {
  const Eigen::AngleAxisd turn(motion.linear());
  Twist twist;
  twist << turn.angle() * turn.axis(), motion.translation();
  return twist;
}

double longest_axis(const Eigen::Matrix3d& covariance) {
  constexpr double chi = 2.7955;  // square root of the 95 % quantile of chi^2 with 3 degrees
  return chi * std::sqrt(std::max(0.0, dense::principal_axes(covariance).values[2]));
}

bool stands_still(std::span<const KeptFrame> frames, std::size_t link) {
  constexpr double same = 1e-6;
  return std::ranges::all_of(frames, [&](const KeptFrame& frame) {
    return frame.T_root_link[link].isApprox(frames.front().T_root_link[link], same);
  });
}

FramePointers pointers_to(std::span<const KeptFrame> frames) {
  FramePointers pointers;
  for (const KeptFrame& frame : frames) pointers.push_back(&frame);
  return pointers;
}

void Unknowns::step(State& state, const Eigen::VectorXd& by) const {
  state.T_parent_camera = state.T_parent_camera * motion(by.head<6>());
  state.T_parent_camera.linear() =
      Eigen::Quaterniond(state.T_parent_camera.linear()).normalized().toRotationMatrix();
  state.depth_offset += by[depth_offset];
  state.depth_scale += by[depth_scale];
  state.outline += by[outline];
  if (has_shift) state.depth_shift += by.segment<2>(shift);
  if (focal_count > 0) state.focal += Eigen::Vector2d(by[focal()], by[joints() - 1]);
  for (std::size_t j = 0; j < variables.size(); ++j)
    state.joint_offsets.at(variables[j]) += by[joints() + static_cast<int>(j)];
  for (std::size_t j = 0; j < links.size(); ++j)
    state.link_lengths.at(links[j]) += by[lengths() + static_cast<int>(j)];
  if (has_time) state.time_offset += by[time()];
  if (has_lens) state.lens += by[lens()];
}

Eigen::VectorXd Unknowns::values(const State& state) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(size());
  if (!holds_depth) {
    all[depth_offset] = state.depth_offset;
    all[depth_scale] = state.depth_scale;
  }
  all[outline] = state.outline;
  if (has_shift) all.segment<2>(shift) = state.depth_shift;
  for (int i = 0; i < focal_count; ++i) all[focal() + i] = state.focal[i];
  for (std::size_t j = 0; j < variables.size(); ++j)
    all[joints() + static_cast<int>(j)] = state.joint_offsets.at(variables[j]);
  for (std::size_t j = 0; j < links.size(); ++j)
    all[lengths() + static_cast<int>(j)] = state.link_lengths.at(links[j]);
  if (has_time) all[time()] = state.time_offset;
  if (has_lens) all[lens()] = state.lens;
  return all;
}

Eigen::VectorXd Unknowns::prior_sigmas() const {
  // Doubted joints and links: rad or m.
  Eigen::VectorXd sigmas = Eigen::VectorXd::Constant(size(), 0.02);
  constexpr double held = 1e-9;  // far below what any measurement tells
  sigmas.head<6>().setConstant(std::numeric_limits<double>::infinity());
  sigmas[depth_offset] = holds_depth ? held : 0.005;
  sigmas[depth_scale] = holds_depth ? held : 0.005;
  sigmas[outline] = 10.0;
  if (has_shift) sigmas.segment<2>(shift).setConstant(10.0);
  sigmas.segment(focal(), focal_count).setConstant(0.1);
  sigmas.segment(lengths() - static_cast<int>(accurate), static_cast<int>(accurate))
      .setConstant(accuracy);
  if (has_time) sigmas[time()] = 0.1;
  if (has_lens) sigmas[lens()] = 0.3;
  return sigmas;
}

namespace {

/// Turns or moves joints by State::joint_offsets, and moves them by State::link_lengths. Planar and
/// floating joints do not turn.
void move_joints(const Robot& robot, const State& state,
                 std::vector<Eigen::Isometry3d>& T_root_link) {
  const std::vector<Eigen::Isometry3d> before = T_root_link;
  const auto& offsets = state.joint_offsets;
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    const Joint& joint = robot.joints()[j];
    Eigen::Isometry3d T_parent_child = before[joint.parent].inverse() * before[joint.child];
    if (!state.link_lengths.empty() && state.link_lengths[j] != 0.0)
      T_parent_child.pretranslate(state.link_lengths[j] * joint.origin.translation().normalized());
    const double by =
        joint.variable && !offsets.empty() ? joint.multiplier * offsets[*joint.variable] : 0.0;
    if (joint.type == JointType::revolute || joint.type == JointType::continuous)
      T_parent_child.rotate(Eigen::AngleAxisd(by, joint.axis));
    else if (joint.type == JointType::prismatic)
      T_parent_child.translate(by * joint.axis);
    T_root_link[joint.child] = T_root_link[joint.parent] * T_parent_child;
  }
}

}  // namespace

std::vector<Eigen::Isometry3d> Model::T_camera_link(const KeptFrame& frame,
                                                    const State& state) const {
  std::vector<Eigen::Isometry3d> poses;
  if (state.time_offset != 0.0 && frame.tells_time())
    poses = poses_at(robot_, frame, state.time_offset);
  if (poses.empty()) poses = frame.T_root_link;
  if (!state.joint_offsets.empty() || !state.link_lengths.empty())
    move_joints(robot_, state, poses);
  const Eigen::Isometry3d T_camera_root = (poses[parent_] * state.T_parent_camera).inverse();
  for (Eigen::Isometry3d& pose : poses) pose = T_camera_root * pose;
  return poses;
}

std::vector<std::vector<Twist>> Model::link_twists(const KeptFrame& frame, const State& state,
                                                   const Unknowns& unknowns) const {
  constexpr double step = 1e-5;  // rad, m or s; far above rounding, far below any curvature
  std::vector<std::vector<Twist>> twists;
  const std::vector<Eigen::Isometry3d> at = T_camera_link(frame, state);
  for (int i = unknowns.joints(); i < unknowns.size(); ++i) {
    State moved = state;
    unknowns.step(moved, step * Eigen::VectorXd::Unit(unknowns.size(), i));
    const std::vector<Eigen::Isometry3d> then = T_camera_link(frame, moved);
    twists.emplace_back();
    for (std::size_t link = 0; link < at.size(); ++link)
      twists.back().push_back(twist_of(then[link] * at[link].inverse()) / step);
  }
  return twists;
}

}  // namespace penumbra::calibration
