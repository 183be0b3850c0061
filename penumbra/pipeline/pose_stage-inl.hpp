// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/labelled_frame-inl.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Returns the link that a camera sits on; the root for an empty name. Throws InputError for what
/// is no link.
[[nodiscard]] std::size_t find_camera_parent(const Robot& robot, const std::string& name);

/// Finds the poses of a robot's links in the optical frame of a camera that sits on one of them.
class PoseStage {
 public:
  /// Links farther than this from the camera, metres, are called a fault of the positions: float32
  /// depths of them would mean nothing.
  static constexpr double max_distance = 1e6;

  /// Throws InputError for a parent that is no link and a camera pose that is no rigid transform or
  /// farther than max_distance. The robot must outlive this.
  PoseStage(const Robot& robot, const PipelineConfig& config,
            std::span<const std::string> missing_links);

  /// Returns the poses, or the fault with a message that says in one line what is wrong. Valid
  /// until the next call. Allocates nothing for a good frame. Throws InputError for doubts of what
  /// is no link.
  PoseResult pose_of(const Frame& frame);

 private:
  void check_doubts(const LinkDoubts& doubts) const;
  FrameStatus check_poses(const Frame& frame);
  FrameStatus check_joints(const JointInput& joints);
  FrameStatus check_links(std::span<const Eigen::Isometry3d> T_root_link);
  FrameStatus place_links(const Frame& frame);
  FrameStatus fault(FrameStatus status, std::string_view message);

  const Robot& robot_;
  std::string missing_links_;  // what the message says of them
  std::size_t parent_;
  Eigen::Isometry3d T_camera_parent_;
  CameraInsideCheck camera_inside_;
  std::vector<Eigen::Isometry3d> T_root_link_;
  std::vector<Eigen::Isometry3d> T_camera_link_;
  Eigen::Isometry3d T_root_camera_ = Eigen::Isometry3d::Identity();
  std::string message_;
};

/// The links' names and meshes; they refer to the robot.
[[nodiscard]] std::vector<Body> bodies_of(const Robot& robot);

/// Of a frame whose joints have that status.
[[nodiscard]] FrameStatus status_of(JointStatus joints);

/// What is missing, stale or disputed, in one line.
[[nodiscard]] std::string describe(const Robot& robot, const JointInput& joints);

}  // namespace penumbra
