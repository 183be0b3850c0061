// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/poses/reach.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// An attached body at its place.
struct PlacedBody {
  std::size_t link;           ///< index into FrameReport::links
  std::string name, carrier;  ///< its own, and the name of the link that carries it
  std::shared_ptr<const PreparedMesh> mesh;
  Eigen::Isometry3d T_camera_body;
};

/// Poses of the robot and its camera at a frame's stamp, or the fault that makes them unknown.
struct PoseResult {
  std::optional<std::int64_t> stamp;                ///< nanoseconds
  FrameStatus status = FrameStatus::ok;             ///< all faults except those of the depth image
  std::string message;                              ///< empty if the status is ok
  std::string note = {};                            ///< as in FrameReport
  std::vector<Eigen::Isometry3d> T_root_link = {};  ///< valid if known()
  std::vector<Eigen::Isometry3d> T_camera_link = {};  ///< valid if known()
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();
  std::vector<PlacedBody> attached = {};        ///< valid if known()
  std::vector<Reach> reaches = {};              ///< of links that are not drawn; valid if known()
  std::vector<std::string> missing_links = {};  ///< as in FrameReport
  std::vector<std::size_t> uncertain_links = {};
  std::string uncertain_reason = {};
  std::span<const std::string> links = {};  ///< as in FrameReport
  std::optional<double> kinematics_ms = {};

  [[nodiscard]] bool known() const { return has_pose(status); }
  [[nodiscard]] bool is_uncertain(std::size_t link) const {
    return std::find(uncertain_links.begin(), uncertain_links.end(), link) != uncertain_links.end();
  }
};

/// Returns the status that makes more of the frame unknown.
[[nodiscard]] constexpr FrameStatus worse(FrameStatus a, FrameStatus b) { return std::max(a, b); }

/// Returns the links with unreadable geometry (RobotOptions::allow_missing_meshes).
[[nodiscard]] std::vector<std::string> missing_links_of(const Robot& robot);

/// Appends a part to a line of parts.
void add_part(std::string& line, std::string_view part);

/// Writes the wall time of its scope, milliseconds.
class StageTimer {
 public:
  explicit StageTimer(std::optional<double>& to) : to_(to) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() { to_ = std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::optional<double>& to_;
  Clock::time_point start_ = Clock::now();
};

/// Computes the poses of a robot's links in the optical frame of a camera on one of them.
class PoseStage {
 public:
  /// Largest distance of a link from the camera, metres. Float32 depths are too coarse beyond.
  static constexpr double max_distance = 1e6;

  /// `camera_parent`, `T_parent_camera`: as in PipelineConfig. Throws InputError for an unknown
  /// parent link, and for a camera pose that is not rigid or farther than max_distance. The robot
  /// must outlive this. `is_camera`: its centre must not lie inside a link.
  PoseStage(const Robot& robot, const std::string& camera_parent,
            const Eigen::Isometry3d& T_parent_camera, std::span<const std::string> missing_links,
            bool is_camera = true);

  /// Returns the poses at a frame's stamp, or the fault and one line about it. `status` and
  /// `message`: a fault that the frame came with. Valid until the next call. Allocates nothing for
  /// a good frame. Throws InputError for uncertain links that do not exist.
  const PoseResult& place(const RobotPose& pose, std::optional<std::int64_t> stamp,
                          FrameStatus status, std::string_view message);

 private:
  void check_uncertain(std::span<const std::size_t> links) const;
  FrameStatus given(FrameStatus status, std::string_view message);
  FrameStatus check_poses(const RobotPose& pose);
  FrameStatus check_joints(std::span<const double> positions);
  FrameStatus check_links(std::span<const Eigen::Isometry3d> T_root_link);
  FrameStatus place_links(const RobotPose& pose);
  FrameStatus place_uncertain();
  void take_out_uncertain();
  void add_reach(std::size_t link, Ball ball);
  FrameStatus place_bodies(std::span<const AttachedBody> bodies);
  FrameStatus place_body(const AttachedBody& body);
  void note_size(const AttachedBody& body);
  [[nodiscard]] std::size_t number_of(const std::string& body);
  FrameStatus fault(FrameStatus status, std::string_view message);

  const Robot& robot_;
  std::vector<std::string> missing_links_;
  std::string without_links_;          // the message about them
  std::vector<std::string> links_;     // the robot's, then attached bodies'; never reallocated
  std::vector<std::size_t> last_use_;  // of the latter: number of the frame
  std::size_t frames_ = 0;
  std::size_t parent_;
  Eigen::Isometry3d T_camera_parent_;
  CameraInsideCheck camera_inside_;
  std::vector<Ball> reach_;  // of each link: reach_of_links
  double length_ = 0.0;      // metres: of all links in a row
  PoseResult result_;
};

}  // namespace penumbra
