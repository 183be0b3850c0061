// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/time/attachments.hpp>
#include <penumbra/time/joint_buffer.hpp>

namespace penumbra {

/// Whether a frame is reliable and, if not, why. Of several faults the status is the first in this
/// order: `missing_joints`, `stale_joints`, `missing_transform`, `stale_transform`,
/// `poses_disagree`, `missing_depth`, `bad_depth`, `missing_link`.
enum class FrameStatus {
  ok,
  missing_joints,     ///< a joint has no (finite) position: the robot's pose is unknown
  stale_joints,       ///< a joint has no state near the stamp: the robot's pose is unknown
  missing_link,       ///< rendered without a link whose mesh could not be read or whose pose is
                      ///< not known, or without an attached body
  missing_depth,      ///< no depth image: every robot pixel is unknown
  bad_depth,          ///< an unusable depth image, or one without any measurement within the
                      ///< sensor's range: every robot pixel is unknown
  missing_transform,  ///< the pose of the camera, or of a link in TF, is unknown or impossible: not
                      ///< rigid, or the camera is inside a link
  stale_transform,    ///< a transform has no state near the stamp: the robot's pose is unknown
  poses_disagree,     ///< joint states and TF differ, or two publishers of one joint or transform:
                      ///< the robot's pose is unknown
};

/// The status's name in report.json.
[[nodiscard]] std::string_view to_string(FrameStatus status);

/// Returns whether the robot's pose is known in a frame of this status.
[[nodiscard]] bool has_pose(FrameStatus status);

/// Returns whether the depth image of a frame of this status can be compared.
[[nodiscard]] constexpr bool has_depth(FrameStatus status) {
  return status == FrameStatus::ok || status == FrameStatus::missing_link;
}

/// The joint positions at the stamp of the depth image. Refers to the caller's memory.
struct JointInput {
  std::span<const double> positions;  ///< order of Robot::variables(), rad and m
  JointStatus status = JointStatus::missing;
  std::optional<std::int64_t> age;         ///< nanoseconds; null if the positions have no stamp
  std::span<const JointGap> gaps;          ///< missing or stale variables, for the message
  std::span<const JointDispute> disputes;  ///< disputed variables, for the message

  JointInput() = default;
  JointInput(std::span<const double> all)  // NOLINT(google-explicit-constructor)
      : positions(all), status(JointStatus::ok) {}
  JointInput(const std::vector<double>& all)  // NOLINT(google-explicit-constructor)
      : JointInput(std::span<const double>(all)) {}
  JointInput(std::vector<double>&&) = delete;  ///< a temporary would dangle
  JointInput(const JointAnswer& answer);       // NOLINT(google-explicit-constructor)
};

/// Bodies that may be attached at once.
inline constexpr std::size_t max_attached = 128;

/// The input of Pipeline::process. Refers to the caller's memory, which must live during the call.
struct Frame {
  std::optional<std::int64_t> stamp = {};  ///< of the depth image, nanoseconds
  DepthView depth = {};                    ///< of the camera's size; empty: missing_depth
  JointInput joints = {};
  /// Poses of all links from another source than joints (TF); the root's is the identity. Empty:
  /// poses follow from `joints`. Otherwise only the age of `joints` is used.
  std::span<const Eigen::Isometry3d> T_root_link = {};
  /// The camera's pose in its parent link in this frame; null: the configuration's.
  std::optional<Eigen::Isometry3d> T_parent_camera = {};
  std::span<const Target> targets = {};
  /// What the robot's links carry, at most max_attached bodies. One that cannot be drawn, because
  /// it has no mesh or its link's pose is not known, is a `missing_link`.
  std::span<const AttachedBody> attached = {};

  /// Links whose pose is unknown although the robot's is known. Targets and estimates given in them
  /// are not judged. Those with geometry are a `missing_link`: pixels are unknown wherever they or
  /// what they carry could be within the limits of their joints, in front of what is measured.
  /// Indices into Robot::links(); process() throws for other values.
  std::span<const std::size_t> uncertain_links = {};
  std::string_view uncertain_reason = {};  ///< one line

  /// A fault that the frame's source reports, and one line about it. The pipeline adds its own.
  FrameStatus source_status = FrameStatus::ok;
  std::string_view source_message = {};
  std::optional<std::size_t> index = {};  ///< in its source; null: the number of the call
};

/// Numbers of pixels by label. If the robot's pose is known,
/// robot = front + occluded + unknown + beyond.
struct PixelCounts {
  std::optional<std::size_t> robot;  ///< virtual depth > 0; null if the robot's pose is unknown
  std::size_t front = 0;
  std::size_t occluded = 0;
  std::size_t unknown = 0;  ///< robot without measurement; without a pose all covered pixels
  std::size_t beyond = 0;
  std::size_t fringe = 0;  ///< next to the robot, with unreliable depth

  /// Pixels outside the lens model (raw image) or outside the camera's view and without robot
  /// (rectified image). They are labelled unknown but counted only here.
  std::size_t uncovered = 0;
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
  bool nothing_measured = false;  ///< no pixel of the depth image is within the sensor's range
  PixelCounts pixels;
  StageTimes timing;

  /// Poses of the camera and of each of the robot's links; null and empty if the robot's pose is
  /// unknown, NaN for a link that is not drawn because its pose is unknown.
  std::optional<Eigen::Isometry3d> T_root_camera;
  std::span<const Eigen::Isometry3d> T_root_link;

  /// Links with a part in view that is nearer than DepthRenderer::near_plane. That part is not
  /// rendered, so pixels behind it are labelled as if it did not exist.
  std::span<const std::size_t> near_links;

  /// All views are empty if the robot's pose is unknown.
  VirtualDepthView virtual_depth;

  /// The frame's depth in the geometry of the label image; empty if there is none. It may refer to
  /// the frame's own image, and is valid as long as that.
  DepthView depth;

  /// Label values; all `unknown` if the robot's pose is unknown.
  ImageView<const std::uint8_t> labels;

  std::span<const TargetReport> targets;  ///< in the order of the frame's targets

  /// Names of the robot's links, then of attached bodies; links[i] has the value i + 1 in link
  /// images. A body keeps its place until max_attached others were attached after it.
  std::span<const std::string> links;
  std::span<const std::size_t> attached;  ///< indices into `links` of this frame's attached bodies
  /// Links rendered without all of their geometry, and attached bodies that are not rendered.
  std::span<const std::string> missing_links;
};

}  // namespace penumbra
