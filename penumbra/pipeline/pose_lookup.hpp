// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/time/pose_history.hpp>

namespace penumbra {

/// Who says where the links are.
enum class PoseSource {
  joints,      ///< joint states, through the URDF
  transforms,  ///< TF
  both         ///< joint states, where TF agrees with them
};
[[nodiscard]] std::string_view to_string(PoseSource source);

struct PoseOptions {
  PoseSource source = PoseSource::joints;
  std::string frame_prefix = {};   ///< before link names in TF, as robot_state_publisher's option
  std::string camera_parent = {};  ///< link that the camera sits on; empty: the root
  /// The camera's optical frame in TF, without the prefix. Empty: the camera's pose in its parent
  /// is the pipeline's own.
  std::string camera_frame = {};
  double agreement = 0.005;  ///< of PoseSource::both: metres, see Disagreement
};

/// How far apart joint states and TF put the link where they agree least, of those drawn and the
/// camera's parent: the larger of its origin's distance and the arc of its turn over the lever.
struct Disagreement {
  static constexpr double lever = 0.5;  ///< metres

  std::size_t link = 0;
  double distance = 0.0;  ///< metres
};

/// Where robot and camera were at a stamp. Of a status other than ok, positions and poses mean
/// nothing.
struct PoseAnswer {
  FrameStatus status = FrameStatus::missing_joints;  ///< of those without a pose, or ok
  std::string message;                               ///< one line; empty if ok
  std::int64_t age = 0;                              ///< nanoseconds to the farthest state used
  bool by_joints = true;                             ///< whether `joints` say where the links are
  JointAnswer joints;                                ///< of PoseSource::joints and both
  std::vector<Eigen::Isometry3d> T_root_link;        ///< of PoseSource::transforms and both: TF's
  std::optional<Eigen::Isometry3d> T_parent_camera;  ///< if the camera's frame is in TF
  std::optional<Disagreement> disagreement;          ///< of PoseSource::both; ok or not
  /// Of an answer that is ok: links whose place is not known for sure, and why, as LinkDoubts has
  /// it.
  std::vector<std::size_t> doubted_links;
  std::string doubt;
};

/// Finds poses of a robot's links and its camera in a history. Takes nothing that is not of the
/// very stamp. One instance serves one thread at a time.
class PoseLookup {
 public:
  /// Throws InputError for a camera parent that is no link, and an agreement that is negative or
  /// not a number. `robot` must outlive this.
  PoseLookup(const Robot& robot, PoseOptions options);

  /// From TF every link is looked up in its parent link. A fixed joint's link whose frame TF never
  /// named is where the URDF says. Joints and transforms that are missing or stale, or of which two
  /// sources tell different values, make the answer so if they move a drawn link or the camera's
  /// parent; else the links that they move are doubted.
  /// Allocates nothing for an answer that is ok, once the answer has been used.
  void at(const PoseHistory& history, std::int64_t stamp, PoseAnswer& answer);

  [[nodiscard]] const PoseOptions& options() const { return options_; }

 private:
  void note_movers();
  template <typename F>
  [[nodiscard]] bool any_variable_above(std::size_t link, const F& is_meant) const;
  void find_joints(const PoseHistory& history, std::int64_t stamp, PoseAnswer& answer) const;
  void judge_unknown_joints(PoseAnswer& answer) const;
  void find_links(const TransformBuffer& transforms, std::int64_t stamp, PoseAnswer& answer);
  void find_camera(const TransformBuffer& transforms, std::int64_t stamp, PoseAnswer& answer);
  void compare(PoseAnswer& answer);
  bool find_transform(const TransformBuffer& transforms, std::int64_t stamp,
                      std::string_view target, std::string_view source, PoseAnswer& answer);

  const Robot& robot_;
  PoseOptions options_;
  std::vector<std::string> frames_;  // of each link, in TF
  std::size_t camera_parent_;
  std::vector<bool> counts_;   // of each link: whether it is drawn or the camera's parent
  std::vector<bool> carries_;  // of each link: one of these, or itself
  std::vector<bool> moves_;    // of each variable: one of these
  std::vector<double> rest_;   // of each variable
  TransformAnswer transform_;  // of the last lookup
  std::vector<Eigen::Isometry3d> T_root_link_;  // by the joint states
};

}  // namespace penumbra
