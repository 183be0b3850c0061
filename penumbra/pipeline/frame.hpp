// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/cloud/scan.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/poses/robot_pose.hpp>
#include <penumbra/robot/trajectory.hpp>
#include <penumbra/targets/target.hpp>

namespace penumbra {

/// An image or a scan, and all that is needed to judge it. A source's images and scans without an
/// owner are valid until its next frame.
struct Frame {
  std::optional<std::size_t> index = {};   ///< in its source; null: the number of the call
  std::optional<std::int64_t> stamp = {};  ///< of the depth image or the scan, nanoseconds
  SharedDepth depth = {};         ///< of the camera's size; empty: missing_depth, unless the
                                  ///< camera has none (PipelineConfig::has_depth)
  std::optional<Scan> scan = {};  ///< of a sensor of points, in place of depth
  RobotPose pose = {};            ///< at the stamp
  /// The pose at any time during a scan, or up to a bag's image; null: `pose` is that of all of it.
  PoseAt pose_at = {};
  std::vector<Target> targets = {};
  /// The motion that the robot follows, or waits to follow; null: none is known. Session tells what
  /// it will hide from a camera.
  std::shared_ptr<const Trajectory> plan = {};
  SharedColor color = {};          ///< for pictures; empty: none
  std::string color_message = {};  ///< why a recorded colour image is not usable; empty if it is
  /// A fault of the depth image or scan that the source reports, and one line about it. The
  /// pipeline adds its own.
  FrameStatus source_status = FrameStatus::ok;
  std::string source_message = {};
};

/// Numbers of pixels by label. robot = front + occluded + unknown + beyond if the robot's pose is
/// known, all of it is drawn and there is usable depth. Of a scan: numbers of points; robot is
/// front + occluded + beyond, and what is unknown may be no measurement.
struct PixelCounts {
  std::optional<std::size_t> robot;  ///< virtual depth > 0; null if the robot's pose is unknown
  std::size_t clear = 0;
  std::size_t front = 0;
  std::size_t occluded = 0;
  std::size_t unknown = 0;  ///< robot without measurement; else as FrameReport::labels
  std::size_t beyond = 0;
  std::size_t fringe = 0;  ///< next to the robot, with unreliable depth

  /// Pixels outside the lens model (raw image) or outside the camera's view and without robot
  /// (rectified image). They are labelled unknown but counted only here.
  std::size_t uncovered = 0;

  /// `robot` is then that of the frames that have it.
  void add(const PixelCounts& other) {
    if (other.robot) robot = robot.value_or(0) + *other.robot;
    clear += other.clear;
    front += other.front;
    occluded += other.occluded;
    unknown += other.unknown;
    beyond += other.beyond;
    fringe += other.fringe;
    uncovered += other.uncovered;
  }
};

/// Wall time of the stages, milliseconds; null for a stage that did not run.
struct StageTimes {
  std::optional<double> kinematics;
  std::optional<double> render;  ///< includes mapping to the raw image
  std::optional<double> classify;
  std::optional<double> targets;  ///< includes storing the frame for late targets
};

/// The pipeline's result for one frame. Views are valid until its next call.
struct FrameReport {
  std::size_t index = 0;
  std::optional<std::int64_t> stamp;      ///< nanoseconds
  std::optional<std::int64_t> joint_age;  ///< nanoseconds
  FrameStatus status = FrameStatus::ok;
  std::string message;            ///< one line; empty if the status is ok
  std::string note;               ///< of an attached body that may be in millimetres; else empty
  bool nothing_measured = false;  ///< no pixel of the depth image is within the sensor's range
  std::size_t parts = 0;          ///< in which a scan was labelled, by poses of its own; 0: no scan
  PixelCounts pixels;
  StageTimes timing;

  /// Poses of the camera and of each of the robot's links; null and empty if the robot's pose is
  /// unknown, NaN for a link that is not drawn because its pose is unknown.
  std::optional<Eigen::Isometry3d> T_root_camera;
  std::span<const Eigen::Isometry3d> T_root_link;

  /// Links with a part in view that is nearer than DepthRenderer::near_plane. That part is not
  /// rendered, so pixels behind it are labelled as if it did not exist.
  std::span<const std::size_t> near_links;

  /// All views are empty if the robot's pose is unknown. Images of a scan are one row of its
  /// points, with links always, and without depths.
  VirtualDepthView virtual_depth;

  /// The frame's depth in the geometry of the label image; empty if there is none. It may refer to
  /// the frame's own image, and is valid as long as that.
  DepthView depth;

  /// Label values; all `unknown` if the robot's pose is unknown. With a missing link, and without
  /// usable depth from a camera that measures it, all but `occluded` and `beyond` are `unknown`. Of
  /// a scan all are, unless the status is ok, or missing_link because the pose of a link is
  /// unknown: then those that it could be at.
  ImageView<const std::uint8_t> labels;

  /// Returns the label of a pixel of that image.
  [[nodiscard]] Label label(int u, int v) const { return static_cast<Label>(labels(u, v)); }

  std::span<const TargetReport> targets;  ///< in the order of the frame's targets

  /// Names of the robot's links, then of attached bodies; links[i] has the value i + 1 in link
  /// images. A body keeps its place until max_attached others were attached after it.
  std::span<const std::string> links;
  std::span<const std::size_t> attached;  ///< indices into `links` of this frame's attached bodies
  /// Links rendered without all of their geometry, and attached bodies that are not rendered.
  std::span<const std::string> missing_links;
};

}  // namespace penumbra
