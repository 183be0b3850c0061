// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/base/virtual_depth.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/time/joint_buffer.hpp>

namespace penumbra {

/// Whether a frame can be relied on, and if not, why. The first that applies, in the order of
/// `missing_joints`, `stale_joints`, `missing_transform`, `stale_transform`, `poses_disagree`,
/// `missing_depth`, `bad_depth`, `missing_link`.
enum class FrameStatus {
  ok,
  missing_joints,     ///< a joint has no (finite) position: the robot's pose is unknown
  stale_joints,       ///< a joint was not seen near the stamp: the robot's pose is unknown
  missing_link,       ///< drawn without a link whose mesh could not be read
  missing_depth,      ///< no depth image: every robot pixel is unknown
  bad_depth,          ///< a depth image that cannot be used, or that holds no measurement within
                      ///< the sensor's range: every robot pixel is unknown
  missing_transform,  ///< the camera's pose, or a link's in TF, is unknown or impossible: inside of
                      ///< a link, no rigid transform
  stale_transform,    ///< a transform was not seen near the stamp: the robot's pose is unknown
  poses_disagree,     ///< joint states and TF differ, or two publishers of one joint or transform:
                      ///< the robot's pose is unknown
};

/// The status's name in report.json.
[[nodiscard]] std::string_view to_string(FrameStatus status);

/// Whether the robot's pose in the camera is known in a frame of this status.
[[nodiscard]] bool has_pose(FrameStatus status);

/// Whether the depth image of a frame of this status can be compared.
[[nodiscard]] constexpr bool has_depth(FrameStatus status) {
  return status == FrameStatus::ok || status == FrameStatus::missing_link;
}

/// Where the joints are at the instant of the depth image. Refers to the caller's memory.
struct JointInput {
  std::span<const double> positions;  ///< order of Robot::variables(), rad and m
  JointStatus status = JointStatus::missing;
  std::optional<std::int64_t> age;  ///< nanoseconds; nothing where the positions have no stamp
  std::span<const JointGap> gaps;   ///< what is missing or stale, where it is known
  std::span<const JointDispute> disputes;  ///< what is disputed, where it is known

  JointInput() = default;
  JointInput(std::span<const double> all)  // NOLINT(google-explicit-constructor)
      : positions(all), status(JointStatus::ok) {}
  JointInput(const std::vector<double>& all)  // NOLINT(google-explicit-constructor)
      : JointInput(std::span<const double>(all)) {}
  JointInput(std::vector<double>&&) = delete;  ///< it would not live as long as a Frame
  JointInput(const JointAnswer& answer);       // NOLINT(google-explicit-constructor)
};

/// Links whose place in a frame is not known though the robot's is: nothing is drawn of them, and
/// the camera is not on them. Targets and estimates that are given in them are not judged. Refers
/// to the caller's memory.
struct LinkDoubts {
  std::span<const std::size_t> links;  ///< indices into Robot::links(); process() throws for others
  std::string_view why;                ///< one line

  [[nodiscard]] bool holds(std::size_t link) const {
    return std::find(links.begin(), links.end(), link) != links.end();
  }
};

/// What goes into Pipeline::process. Refers to the caller's memory, needed during the call only.
struct Frame {
  std::optional<std::int64_t> stamp = {};  ///< of the depth image, nanoseconds
  DepthView depth = {};                    ///< of the camera's size; empty: missing_depth
  JointInput joints = {};
  /// Poses of the links, one for each, that are known otherwise than by joints (from TF): `joints`
  /// then says their age alone. Empty: by joints. The root's is the identity.
  std::span<const Eigen::Isometry3d> T_root_link = {};
  /// The camera's pose in its parent link in this frame; nothing: the configuration's.
  std::optional<Eigen::Isometry3d> T_parent_camera = {};
  std::span<const Target> targets = {};
  LinkDoubts doubts = {};

  /// What the frame's source knows to be wrong with it, and one line that says so. What the
  /// pipeline finds on its own is added.
  FrameStatus source_status = FrameStatus::ok;
  std::string_view source_message = {};
  std::optional<std::size_t> index = {};  ///< in its source; nothing: the pipeline counts its calls
};

/// How many pixels of the label image have each label. Where the robot's pose is known,
/// robot = front + occluded + unknown + beyond.
struct PixelCounts {
  std::optional<std::size_t> robot;  ///< VDI > 0; nothing where the robot's pose is unknown
  std::size_t front = 0;
  std::size_t occluded = 0;
  std::size_t unknown = 0;  ///< robot without measurement; every covered pixel without a pose
  std::size_t beyond = 0;
  std::size_t fringe = 0;  ///< beside the robot: depth not to be trusted

  /// Pixels of the raw image that the lens model does not reach, or of the rectified one that the
  /// camera did not see and that show no robot: labelled unknown, counted here alone.
  std::size_t uncovered = 0;
};

/// Wall time of the stages, milliseconds; nothing for a stage that did not run.
struct StageTimes {
  std::optional<double> kinematics;
  std::optional<double> render;  ///< and mapping to the raw image
  std::optional<double> classify;
  std::optional<double> targets;  ///< and keeping the frame for late ones
};

/// What the pipeline says of one frame. Views are valid until the next call of the pipeline.
struct FrameReport {
  std::size_t index = 0;
  std::optional<std::int64_t> stamp;      ///< nanoseconds
  std::optional<std::int64_t> joint_age;  ///< nanoseconds
  FrameStatus status = FrameStatus::ok;
  std::string message;            ///< one line for every status but ok
  bool nothing_measured = false;  ///< no pixel of the depth image is within the sensor's range
  PixelCounts pixels;
  StageTimes timing;

  /// Where the camera and each link were; nothing and empty where the robot's pose is unknown.
  std::optional<Eigen::Isometry3d> T_root_camera;
  std::span<const Eigen::Isometry3d> T_root_link;

  /// Indices of the links of which a part lies nearer than DepthRenderer::near_plane on the image's
  /// rays: it is not drawn, and what it hides is labelled as if it were not there.
  std::span<const std::size_t> near_links;

  /// Of this frame; all views empty where the robot's pose is unknown.
  VirtualDepthView virtual_depth;

  /// The frame's depth as it was compared: in the image of the labels; empty where there is none.
  /// Refers to the frame's own image where that is the same, and is valid as long.
  DepthView depth;

  /// Label values; all `unknown` where the robot's pose is unknown.
  ImageView<const std::uint8_t> labels;

  std::span<const TargetReport> targets;  ///< one for each of the frame's, in their order

  std::span<const std::string> links;          ///< names: links[i] stands as i + 1 in link images
  std::span<const std::string> missing_links;  ///< links drawn without (all of) their geometry
};

}  // namespace penumbra
