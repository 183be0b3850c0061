// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/tracking/trackers.hpp>

namespace penumbra {

/// Largest distance and size of a target, metres. Float32 depths are too coarse beyond.
inline constexpr double max_target_distance = 1e6;
/// No sensor of a robot sees farther, metres.
inline constexpr double farthest_target = 250.0;

/// The frame in which a position or pose is given; by default the camera's optical frame.
struct ReferenceFrame {
  enum class Kind { camera, root, link };

  static ReferenceFrame root() { return {Kind::root, {}}; }
  static ReferenceFrame of_link(std::string name) { return {Kind::link, std::move(name)}; }

  Kind kind = Kind::camera;
  std::string link = {};  ///< name, for Kind::link
};

/// Pixels of the report's images (PipelineConfig::image).
struct RegionTarget {
  Region region;
  Extent extent = Extent::amodal;
  std::optional<double> expected_depth = {};  ///< metres, > 0
  /// Metres, > 0: of an object that stands upright. Its expected depth then follows from the
  /// region's height; while the robot may hide a part of a modal region, it is the last one.
  std::optional<double> height = {};
};

/// A network's key point; judged as an ellipse around it.
struct KeypointTarget {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the report's images
  double score = 1.0;                               ///< of the network; below min_score: unknown
  double min_score = 0.0;
  Eigen::Vector2d semi_axes = Eigen::Vector2d(5, 5);  ///< pixels, or metres if in_metres; > 0
  double angle = 0.0;  ///< radians from +u to +v: of the first semi-axis
  /// True: lengths are metres at the expected depth or, without it, at the depth measured at the
  /// pixel. That pixel must be labelled clear or front, else the verdict is unknown.
  bool in_metres = false;
  std::optional<double> expected_depth = {};  ///< metres, > 0
};

/// A sphere around a point; judged as its elliptical outline at the point's depth.
struct PointTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  double radius = 0.02;                                ///< metres, > 0
  ReferenceFrame frame = {};
};

/// A box; it is rendered alone, which gives each pixel's expected depth.
struct BoxTarget {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the centre; axes along the edges
  Eigen::Vector3d size = Eigen::Vector3d::Zero();          ///< full edge lengths, metres, > 0
  ReferenceFrame frame = {};
};

/// A mesh; it is rendered alone. Pass the same pointer for the same mesh: its renderer is kept.
struct MeshTarget {
  std::shared_ptr<const PreparedMesh> mesh;  ///< in the object's frame
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  ReferenceFrame frame = {};
};

/// std::monostate: not found in this frame; the verdict is unknown and handling continues.
using TargetShape =
    std::variant<std::monostate, RegionTarget, KeypointTarget, PointTarget, BoxTarget, MeshTarget>;

/// A pose or position of a target from the perception system.
struct TargetEstimate {
  /// std::monostate: not found in this frame, and the shape's own pose is not used either.
  std::variant<Eigen::Isometry3d, Eigen::Vector3d, std::monostate> value =
      Eigen::Isometry3d::Identity();
  std::optional<std::int64_t> stamp = {};  ///< of its image, nanoseconds; null: the target's
  ReferenceFrame frame = {};               ///< at that stamp
  /// Of position and rotation vector along the axes of `frame`; a point uses the first 3 x 3.
  std::optional<Matrix6d> covariance = {};
};

/// How a target is followed while hidden: not at all, as a pose, or as a point.
using TargetHandling = std::variant<std::monostate, PoseTrackerConfig, PointTrackerConfig>;

/// A target to judge in a frame. Any fault of a target makes its verdict unknown and is the
/// report's reason.
struct Target {
  std::string name;  ///< not empty, unique in a frame; verdicts and tracks are stored by it
  /// False: the name may belong to another object in the next frame (for example, the index of a
  /// detection). Each frame judges the target as new, and it cannot be handled.
  bool has_identity = true;
  TargetShape shape = {};
  std::string frame_id = {};               ///< of its image; empty, or the camera's
  std::optional<std::int64_t> stamp = {};  ///< of its image, nanoseconds; null: the frame's
  /// Metres between its surface and its expected depth at most: half its thickness plus its pose's
  /// uncertainty. A PointTarget's radius is added.
  double depth_margin = 0.0;
  TargetThresholds thresholds = {};
  /// Read at the first frame with this name, and again after Pipeline::forget_target.
  TargetHandling handling = {};
  /// What tracking takes as its measurement. Null: the pose or position of a 3-D shape or, for
  /// handling as a point, the point measured in the region or at the key point.
  std::optional<TargetEstimate> estimate = {};
  std::string fault = {};  ///< a fault that its source reports; empty: none
};

/// The place of a 3-D shape.
struct ShapePlacement {
  Eigen::Isometry3d pose;  ///< in `frame`; of a point: without rotation
  ReferenceFrame frame;
};

/// Returns the place of a point, 3-D box or mesh; null for other shapes.
[[nodiscard]] std::optional<ShapePlacement> placement_of(const TargetShape& shape);

/// Sets the place of such a shape; others stay as they are.
void place(TargetShape& shape, const ShapePlacement& at);

/// Returns whether a shape is rendered alone.
[[nodiscard]] bool is_rendered(const TargetShape& shape);

/// Throw InputError for a shape, name or settings that are invalid in every frame. The pixels of a
/// region are checked only together with an image.
void check_shape(const TargetShape& shape);
void check_target(const Target& target);

/// Throws InputError for a target or estimate that is as far away, or as large with the camera
/// inside, as only one in millimetres is. `T_camera_frame`: returns the pose of a frame in the
/// camera's or the sensor's; may throw InputError for one that is not known.
void check_distance(const Target& target,
                    const std::function<Eigen::Isometry3d(const ReferenceFrame&)>& T_camera_frame);

/// Throws InputError for a pose that is not rigid or more than max_target_distance away, and for
/// one in the camera's frame that is nearer than DepthRenderer::near_plane.
void check_estimate(const TargetEstimate& estimate);

/// A handled target at the frame's stamp, in the root link's frame. While a link carries the
/// target, its pose is that of the attached body, and estimates are refused. Then tracking starts
/// from the last such pose.
struct HandledTarget {
  Source source = Source::lost;
  double age = 0;  ///< seconds since the last accepted estimate; infinite before the first
  std::optional<Eigen::Vector3d> position;        ///< metres; null if lost
  std::optional<Eigen::Quaterniond> orientation;  ///< null if lost, or handled as a point
  double sigma = 0;  ///< metres, along the position's most uncertain direction
  /// Seconds until it is lost, because the robot's plan hides it for longer than its timeout; null:
  /// it will not be, or there is no forecast.
  std::optional<double> lost_in = {};
};

/// Neighbouring times of one verdict.
struct VerdictInterval {
  double begin = 0.0, end = 0.0;  ///< seconds from the start of the motion
  Verdict verdict = Verdict::unknown;
  double hidden = 0.0;  ///< largest share
  double seen = 0.0;    ///< seconds for which it is seen or held, by the share that is not hidden
  std::string by = {};  ///< what hides most of it then
  std::string reason = {};  ///< of the first unknown verdict
};

/// Intervals without gaps, of a motion or of the rest of it.
using Forecast = std::vector<VerdictInterval>;

/// The result for one target.
struct TargetReport {
  std::string name;
  std::optional<std::int64_t> stamp;  ///< of the frame on which it was judged, nanoseconds
  Verdict verdict = Verdict::unknown;
  std::string reason;  ///< one line if the verdict is unknown or held, else empty

  /// Null if no pixels were judged. The judge's values except `point`.
  std::optional<Judgement> judgement;
  std::optional<Eigen::Vector3d> point;  ///< from trusted depths only; root link's frame, metres

  std::optional<HandledTarget> handled;  ///< null without handling, or without stamps
  std::optional<Outcome> estimate;       ///< whether the target's estimate was accepted, or why
                                         ///< not; null without an estimate
  /// What the rest of Frame::plan will hide of it, seconds from the frame on. Empty: there is no
  /// plan, or it has ended.
  Forecast forecast;
  bool wants_stamp = false;  ///< not handled because the frame has no stamp
};

}  // namespace penumbra
