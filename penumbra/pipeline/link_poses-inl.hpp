// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// The link that a camera sits on; the root for an empty name. Throws InputError for what is no
/// link.
[[nodiscard]] std::size_t find_camera_parent(const Robot& robot, const std::string& name);

/// Poses of a robot's links in the optical frame of a camera that sits on one of them.
class LinkPoses {
 public:
  /// Links farther than this from the camera, metres, are called a fault of the positions: float32
  /// depths of them would mean nothing.
  static constexpr double max_distance = 1e6;

  /// Throws InputError for a parent that is no link and a camera pose that is no rigid transform or
  /// farther than max_distance.
  LinkPoses(const Robot& robot, const PipelineConfig& config);

  /// Computes T_camera_link of every link by the frame's joints or poses, which FrameCheck found
  /// ok; nothing is at fault with them if it answers nothing, else the index of a link that they
  /// put nowhere near.
  std::optional<std::size_t> update(const Frame& frame);

  [[nodiscard]] std::span<const Eigen::Isometry3d> T_camera_link() const { return T_camera_link_; }
  [[nodiscard]] std::span<const Eigen::Isometry3d> T_root_link() const { return T_root_link_; }
  [[nodiscard]] const Eigen::Isometry3d& T_root_camera() const { return T_root_camera_; }

 private:
  const Robot& robot_;
  std::size_t parent_;
  Eigen::Isometry3d T_camera_parent_;
  std::vector<Eigen::Isometry3d> T_root_link_;
  std::vector<Eigen::Isometry3d> T_camera_link_;
  Eigen::Isometry3d T_root_camera_ = Eigen::Isometry3d::Identity();
};

}  // namespace penumbra
