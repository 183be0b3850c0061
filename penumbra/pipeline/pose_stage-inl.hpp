// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// Returns the link that carries a camera; the root for an empty name. Throws InputError for an
/// unknown name.
[[nodiscard]] std::size_t find_camera_parent(const Robot& robot, const std::string& name);

/// Computes the poses of a robot's links in the optical frame of a camera on one of them.
class PoseStage {
 public:
  /// Largest distance of a link from the camera, metres. Float32 depths are too coarse beyond.
  static constexpr double max_distance = 1e6;

  /// Throws InputError for an unknown parent link, and for a camera pose that is not rigid or
  /// farther than max_distance. The robot must outlive this.
  PoseStage(const Robot& robot, const PipelineConfig& config,
            std::span<const std::string> missing_links);

  /// Returns the poses, or the fault and one line about it. Valid until the next call. Allocates
  /// nothing for a good frame. Throws InputError for uncertain links that do not exist.
  const PoseResult& pose_of(const Frame& frame);

  /// As FrameReport::links.
  [[nodiscard]] std::span<const std::string> links() const { return links_; }

 private:
  void check_uncertain(std::span<const std::size_t> links) const;
  FrameStatus check_poses(const Frame& frame);
  FrameStatus check_joints(const JointInput& joints);
  FrameStatus check_links(std::span<const Eigen::Isometry3d> T_root_link);
  FrameStatus place_links(const Frame& frame);
  FrameStatus place_uncertain();
  void add_reach(std::size_t link, Ball ball);
  FrameStatus place_bodies(std::span<const AttachedBody> bodies);
  FrameStatus place_body(const AttachedBody& body);
  [[nodiscard]] std::size_t number_of(const std::string& body);
  FrameStatus fault(FrameStatus status, std::string_view message);

  const Robot& robot_;
  std::vector<std::string> missing_links_;
  std::string without_links_;          // the message about them
  std::vector<std::string> links_;     // the robot's, then attached bodies'
  std::vector<std::size_t> last_use_;  // of the latter: number of the frame
  std::size_t frames_ = 0;
  std::size_t parent_;
  Eigen::Isometry3d T_camera_parent_;
  CameraInsideCheck camera_inside_;
  std::vector<Ball> reach_;  // of each link: reach_of_links
  PoseResult result_;
};

/// Returns the status of a frame with joints of that status.
[[nodiscard]] FrameStatus status_of(JointStatus joints);

/// Returns one line about missing, stale or disputed joints.
[[nodiscard]] std::string describe(const Robot& robot, const JointInput& joints);

}  // namespace penumbra
