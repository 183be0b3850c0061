// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/base/rigid-inl.hpp>
#include <penumbra/pipeline/link_poses-inl.hpp>

namespace penumbra {

std::size_t find_camera_parent(const Robot& robot, const std::string& name) {
  if (name.empty()) return 0;
  if (const auto link = robot.find_link(name)) return *link;
  std::string known;
  for (const std::string& link : robot.links()) known += (known.empty() ? "" : ", ") + link;
  throw InputError("camera parent '" + name + "' is no link of robot '" + robot.name() +
                   "'; its links: " + known);
}

LinkPoses::LinkPoses(const Robot& robot, const PipelineConfig& config)
    : robot_(robot),
      parent_(find_camera_parent(robot, config.camera_parent)),
      T_root_link_(robot.links().size()),
      T_camera_link_(robot.links().size()) {
  if (!is_rigid(config.T_parent_camera))
    throw InputError(
        "camera pose is no rigid transform: a rotation (orthonormal, determinant 1) and a finite "
        "translation in metres are needed");
  if (config.T_parent_camera.translation().cwiseAbs().maxCoeff() > max_distance)
    throw InputError("camera pose is more than 1000 km from its parent link; metres are wanted");
  T_camera_parent_ = config.T_parent_camera.inverse();
}

std::optional<std::size_t> LinkPoses::update(const Frame& frame) {
  if (frame.T_root_link.empty())
    robot_.forward_kinematics(frame.joints.positions, T_root_link_);
  else
    std::copy(frame.T_root_link.begin(), frame.T_root_link.end(), T_root_link_.begin());
  const Eigen::Isometry3d T_camera_parent =
      frame.T_parent_camera ? frame.T_parent_camera->inverse() : T_camera_parent_;
  const Eigen::Isometry3d T_camera_root = T_camera_parent * T_root_link_[parent_].inverse();
  T_root_camera_ = T_camera_root.inverse();
  for (std::size_t i = 0; i < T_root_link_.size(); ++i) {
    T_camera_link_[i] = T_camera_root * T_root_link_[i];
    const bool near = T_camera_link_[i].translation().cwiseAbs().maxCoeff() <= max_distance &&
                      T_camera_link_[i].matrix().allFinite();
    if (!near) return i;
  }
  return std::nullopt;
}

}  // namespace penumbra
