// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/cloud/cloud_labels.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// The points of a scan, or of a cloud that is measured at once, in the sensor's frame.
struct Scan {
  std::optional<std::int64_t> stamp = {};  ///< nanoseconds
  PointsView points = {};
  /// When each point was measured: nanoseconds after the stamp. Empty: all at the stamp, as points
  /// without rays are.
  std::span<const std::int32_t> times = {};
  /// Where the rays start, in the points' frame. Null: points without rays, as of merged clouds.
  std::optional<Eigen::Vector3d> origin = Eigen::Vector3d::Zero();
  /// 3-D boxes and points to judge, by the poses at the scan's begin; one with another stamp is
  /// unknown. ReferenceFrame::camera: the points' frame.
  std::span<const Target> targets = {};
};

/// Sets `pose` to the robot's pose at a stamp, or its fault, as PoseLookup::at.
using PoseAt = std::function<void(std::int64_t stamp, RobotPose& pose)>;

struct CloudConfig {
  CloudRule rule = {};
  int threads = 1;
  std::string sensor_parent = {};  ///< link that carries the sensor; empty: the root
  /// Pose of the points' frame in that link's frame, metres. RobotPose::T_parent_camera, where
  /// given, replaces it.
  Eigen::Isometry3d T_parent_sensor = Eigen::Isometry3d::Identity();
};

/// The result for one scan. Spans are valid until the next call.
struct CloudReport {
  std::optional<std::int64_t> stamp;  ///< nanoseconds
  /// bad_depth: no point is a measurement. All points are unknown unless the status is ok, or
  /// missing_link because the pose of a link is unknown: then those that it could be at.
  FrameStatus status = FrameStatus::ok;
  std::string message;                            ///< one line; empty if the status is ok
  std::string note;                               ///< as FrameReport::note
  std::span<const std::uint8_t> labels;           ///< values of Label, one for each point
  std::span<const std::uint16_t> point_links;     ///< index + 1 in `links`; 0: none
  std::array<std::size_t, label_count> points{};  ///< their number, by label
  std::size_t parts = 0;  ///< in which the scan was labelled, each with its own poses
  /// The robot's links in the points' frame in the scan's first part, without what is attached;
  /// NaN: the pose is not known. Empty: none is.
  std::span<const Eigen::Isometry3d> T_sensor_link;
  std::span<const TargetReport> targets;  ///< in the order of the scan's
  std::span<const std::string> links;     ///< as FrameReport::links
};

/// Labels the scans of one sensor by the poses of a robot. During a scan with times the poses are
/// looked up so often that no link moves by more than 1 cm in between, or max_parts times. Serves
/// one thread at a time.
class CloudPipeline {
 public:
  static constexpr std::size_t max_parts = 64;
  /// Metres. If half of the points are farther away, they are no measurement: no sensor of a
  /// robot's surroundings sees so far, and millimetres are mistaken for metres.
  static constexpr double max_range = 300.0;

  /// Throws InputError as CloudLabeller and for an unknown parent or a pose that is not rigid.
  CloudPipeline(Robot robot, const CloudConfig& config = {});
  ~CloudPipeline();
  CloudPipeline(CloudPipeline&&) noexcept;
  CloudPipeline& operator=(CloudPipeline&&) noexcept;

  /// Labels a scan, and judges its targets on the rays that meet them; what has no measured ray, or
  /// is of a cloud without rays, is unknown. Calls `pose_at` for stamps of the scan; without a
  /// stamp, for times after 0. Bodies attached by the pose at the scan's begin are labelled, too;
  /// the first scan with others takes as long as the construction.
  const CloudReport& process(const Scan& scan, const PoseAt& pose_at);

  /// Labels by another rule from now on. Throws InputError for an invalid one.
  void set_rule(const CloudRule& rule);

  [[nodiscard]] const Robot& robot() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
