// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/joint_buffer.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

/// Whether a frame is reliable and, if not, why: the worst of its faults, in this order.
enum class FrameStatus {
  ok,
  missing_link,       ///< rendered without a link whose mesh could not be read or whose pose is
                      ///< not known, or without an attached body
  bad_depth,          ///< an unusable depth image, or one without any measurement within the
                      ///< sensor's range: every pixel is unknown
  missing_depth,      ///< no depth image: every pixel is unknown
  poses_disagree,     ///< joint states and TF differ, or two publishers of one joint or transform:
                      ///< the robot's pose is unknown
  stale_transform,    ///< a transform has no state near the stamp, and without it there is no pose
  missing_transform,  ///< the pose of the camera, or of a link in TF, is unknown or impossible: not
                      ///< rigid, or the camera is inside a link
  stale_joints,       ///< a joint has no state near the stamp, and without it there is no pose
  missing_joints,     ///< a joint has no (finite) position, and without it there is no pose
};

/// The status's name in report.json.
[[nodiscard]] std::string_view to_string(FrameStatus status);

/// Returns whether the robot's pose is known in a frame of this status.
[[nodiscard]] constexpr bool has_pose(FrameStatus status) {
  return status < FrameStatus::poses_disagree;
}

/// Returns whether the depth image of a frame of this status can be compared.
[[nodiscard]] constexpr bool has_depth(FrameStatus status) {
  return status == FrameStatus::ok || status == FrameStatus::missing_link;
}

/// Bodies that may be attached at once.
inline constexpr std::size_t max_attached = 128;

/// The robot's pose at a stamp, and the camera's on it.
struct RobotPose {
  FrameStatus status = FrameStatus::ok;  ///< another one: the pose is unknown
  std::string message = {};              ///< one line that says why; empty if the status is ok
  /// Order of Robot::variables(), rad and m. Another number of them is `missing_joints`. Unused if
  /// there are poses of links. PoseLookup sets either also if only the camera's pose is unknown.
  std::vector<double> positions = {};
  std::optional<std::int64_t> age = {};  ///< nanoseconds from the stamp to the farthest state used
  /// Poses of all links, if they do not follow from `positions` alone; the root's is the identity.
  std::vector<Eigen::Isometry3d> T_root_link = {};
  /// The camera's pose in its parent link; null: Camera's, or CloudConfig's.
  std::optional<Eigen::Isometry3d> T_parent_camera = {};
  /// Links whose pose is unknown although the robot's is known. Targets and estimates given in them
  /// are not judged. Those with geometry are a `missing_link`: pixels are unknown wherever they or
  /// what they carry could be within the limits of their joints, in front of what is measured.
  /// Indices into Robot::links(); Pipeline::process() throws for other values.
  std::vector<std::size_t> uncertain_links = {};
  std::string uncertain_reason = {};  ///< one line
  /// What the robot's links carry, at most max_attached bodies. One that cannot be drawn, because
  /// it has no mesh or its link's pose is not known, is a `missing_link`.
  std::vector<AttachedBody> attached = {};
};

/// Returns the status of a frame with joints of that status.
[[nodiscard]] FrameStatus status_of(JointStatus joints);

/// Returns, of each link, whether the joint above it cannot be placed because of unknown variables.
/// One of a disputed variable takes the whole robot along.
[[nodiscard]] std::vector<bool> lost_joints(const Robot& robot,
                                            std::span<const std::size_t> unknown,
                                            std::span<const std::size_t> disputed = {});

/// Adds the links below lost joints. Of several robots one whose moving joints are all lost is
/// added as a whole; the only robot has no pose then. Returns false without a change if the frame
/// has no pose: in that case, and if the link `camera_parent` is below a lost joint. Joints that
/// move neither geometry nor the camera do not count.
[[nodiscard]] bool add_uncertain_links(const Robot& robot, const std::vector<bool>& is_lost,
                                       std::size_t camera_parent,
                                       std::vector<std::size_t>& uncertain);

/// Makes links uncertain that unknown variables move, as add_uncertain_links; all get the poses
/// that follow from `positions`, which are then empty. Returns false if there is no pose.
[[nodiscard]] bool leave_out(std::span<const std::size_t> unknown, const Robot& robot,
                             std::size_t camera_parent, RobotPose& pose);

/// Returns one line about missing, stale or disputed joints.
[[nodiscard]] std::string describe(const Robot& robot, const JointAnswer& joints);

/// Returns which settings do without joints that were never seen; empty if there are none.
[[nodiscard]] std::string remedy_of(const Robot& robot, const JointAnswer& joints);

/// Returns a pose by joint states. Links below missing or stale joints are uncertain; it is
/// unknown, with the reason, if all joints are, or one is disputed.
[[nodiscard]] RobotPose pose_of(const Robot& robot, const JointAnswer& joints);

/// Returns the links' names and meshes, which refer to the robot, for make_depth_renderer.
[[nodiscard]] std::vector<Body> bodies_of(const Robot& robot);

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
