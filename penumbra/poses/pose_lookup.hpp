// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

/// The source of the links' poses.
enum class PoseSource {
  joints,      ///< joint states, through the URDF
  transforms,  ///< TF
  both         ///< joint states, which must agree with TF within 5 mm, and within the arc of
               ///< 5 mm at 0.5 m for rotations
};
[[nodiscard]] std::string_view to_string(PoseSource source);

struct PoseOptions {
  PoseSource source = PoseSource::joints;
  std::string frame_prefix = {};   ///< of link names in TF, as robot_state_publisher's option
  std::string camera_parent = {};  ///< link that carries the camera; empty: the root
  /// The camera's optical frame in TF, without the prefix. Empty: the pipeline's configuration has
  /// the camera's pose.
  std::string camera_frame = {};
};

/// Looks up the poses of a robot's links and camera at a stamp. Never extrapolates. One instance
/// serves one thread at a time.
class PoseLookup {
 public:
  /// Throws InputError for an unknown camera parent. `robot` must outlive this.
  PoseLookup(const Robot& robot, PoseOptions options);

  /// TF is looked up from link to parent link; a fixed joint whose frame TF never named has the
  /// URDF's pose. The mount of a robot (Robot::join) follows TF, whatever the source, unless TF
  /// never named "world". Links that a missing or stale joint or transform moves are uncertain. A
  /// robot is uncertain as a whole if none of its joints that move geometry is known, or if one is
  /// disputed. It is a fault if the only robot is, or the link that carries the camera.
  /// Allocates nothing for a pose that is ok, once `pose` has been used.
  void at(const PoseHistory& history, std::int64_t stamp, RobotPose& pose);

  /// Of the last lookup: the newest state, nanoseconds, of what is uncertain because no state has
  /// reached the stamp yet; 0 if it has no state; null if there is nothing such.
  [[nodiscard]] std::optional<std::int64_t> late_since() const { return late_since_; }

 private:
  void find_joints(const PoseHistory& history, std::int64_t stamp, RobotPose& pose);
  [[nodiscard]] bool is_moved_by_tf(const TransformBuffer& transforms) const;
  void judge_unknown_joints(const JointBuffer& joints, std::int64_t stamp, RobotPose& pose);
  void find_links(const TransformBuffer& transforms, std::int64_t stamp, RobotPose& pose);
  void find_camera(const TransformBuffer& transforms, std::int64_t stamp, RobotPose& pose);
  void find_mounts(const TransformBuffer& transforms, std::int64_t stamp, RobotPose& pose);
  bool find_joint(const TransformBuffer& transforms, std::int64_t stamp, const Joint& joint,
                  RobotPose& pose);
  void forget_lost();
  void settle_lost(RobotPose& pose);
  void note_late(std::optional<std::int64_t> newest, std::int64_t stamp);
  void compare(RobotPose& pose);
  [[nodiscard]] std::size_t root_of(std::size_t link) const;
  bool find_transform(const TransformBuffer& transforms, std::int64_t stamp,
                      std::string_view target, std::string_view source, RobotPose& pose);

  /// Joints that TF lacks.
  struct Lost {
    std::vector<bool> is_lost;  ///< of each link: the joint above it
    FrameStatus status = FrameStatus::ok;
    std::string message = {};  ///< of the first needed one, else of the first
    bool is_needed = false;
  };

  const Robot& robot_;
  PoseOptions options_;
  std::vector<std::string> frames_;  // of each link, in TF
  std::size_t camera_parent_;
  std::vector<bool> is_needed_;        // of each link: has geometry, or carries the camera
  std::vector<bool> leads_to_needed_;  // of each link: needed, or an ancestor of a needed link
  std::vector<bool> moves_needed_;     // of each variable
  std::vector<double> rest_;           // of each variable
  // Of the last lookup.
  JointAnswer joints_;
  TransformAnswer transform_;
  std::vector<Eigen::Isometry3d> T_root_found_;  // by transforms
  std::optional<std::int64_t> late_since_;
  std::vector<Eigen::Isometry3d> T_root_link_;  // by the joint states
  bool follows_from_joints_ = true;             // T_root_link_ from the positions alone
  Lost lost_;
};

}  // namespace penumbra
