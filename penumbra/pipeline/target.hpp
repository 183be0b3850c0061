// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/mesh/triangle_mesh.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/targets/target_judge.hpp>
#include <penumbra/tracking/point_tracker.hpp>
#include <penumbra/tracking/pose_tracker.hpp>
#include <penumbra/tracking/track.hpp>

namespace penumbra {

/// Nothing of a target lies farther, or is larger: float32 depths beyond would mean nothing.
/// Metres.
inline constexpr double max_target_distance = 1e6;

/// The frame of a position or pose: nothing is the camera's optical frame, an empty name the
/// robot's root link, else the link of that name.
using LinkFrame = std::optional<std::string_view>;

/// Pixels of the report's images (PipelineConfig::image).
struct RegionTarget {
  Region region;
  Extent extent = Extent::amodal;
  std::optional<double> expected_depth = {};  ///< metres, > 0
};

/// A key point of a network; an ellipse around it is judged.
struct KeypointTarget {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the report's images
  double score = 1.0;                               ///< the network's; below min_score: unknown
  double min_score = 0.0;
  Eigen::Vector2d semi_axes = Eigen::Vector2d(5, 5);  ///< pixels, or metres if in_metres; > 0
  double angle = 0.0;  ///< radians from +u to +v: of the first semi-axis
  /// Lengths are metres at the expected depth; without that at the depth measured at the pixel.
  /// Where that is not labelled clear or front, it may be the robot's: the verdict is unknown.
  bool in_metres = false;
  std::optional<double> expected_depth = {};  ///< metres, > 0
};

/// A ball around a point. Judged as the ellipse that is its outline, at the point's depth.
struct PointTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< metres
  double radius = 0.02;                                ///< metres, > 0
  LinkFrame frame = {};
};

/// A box, rendered alone, so that each pixel's expected depth is known.
struct BoxTarget {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of its centre, axes along its edges
  Eigen::Vector3d size = Eigen::Vector3d::Zero();          ///< whole edges, metres, > 0
  LinkFrame frame = {};
};

/// A mesh, rendered alone. Give the same pointer again for the same mesh: what was made ready for
/// rendering is kept by it.
struct MeshTarget {
  std::shared_ptr<const TriangleMesh> mesh;  ///< in the object's frame
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  LinkFrame frame = {};
};

/// std::monostate: not found in this frame. Its verdict is unknown; handling goes on.
using TargetShape =
    std::variant<std::monostate, RegionTarget, KeypointTarget, PointTarget, BoxTarget, MeshTarget>;

/// What the perception system says of a target's whereabouts.
struct TargetEstimate {
  /// std::monostate: it found none in this frame, and nothing else stands for it.
  std::variant<Eigen::Isometry3d, Eigen::Vector3d, std::monostate> value =
      Eigen::Isometry3d::Identity();
  std::optional<std::int64_t> stamp = {};  ///< of its image, nanoseconds; nothing: the target's
  LinkFrame frame = {};                    ///< at that stamp
  /// Of position and rotation vector along the axes of `frame`; a point takes the first 3 x 3.
  std::optional<Matrix6d> covariance = {};
};

/// How a target is carried on while it is hidden: not, as a pose, or as a point.
using TargetHandling = std::variant<std::monostate, PoseTrackerConfig, PointTrackerConfig>;

/// What is to be judged in a frame. Refers to the caller's memory, needed during the call only.
/// Whatever is wrong with a target makes its verdict unknown and is said in the report's reason.
struct Target {
  std::string_view name;  ///< not empty; once per frame: by it verdicts and tracks are remembered
  /// False: the name may be another object's in the next frame, as one made of a detection's place
  /// in its message. It is judged as if for the first time in each frame, and cannot be handled.
  bool has_identity = true;
  TargetShape shape = {};
  std::string_view frame_id = {};  ///< of its image; if given, the camera's: others are refused
  std::optional<std::int64_t> stamp = {};  ///< of its image, nanoseconds; nothing: the frame's
  /// Metres by which its surface may lie before or behind its expected depth: half its thickness,
  /// its pose's uncertainty. A PointTarget's radius is added.
  double depth_margin = 0.0;
  TargetThresholds thresholds = {};
  /// Taken when the name comes first; Pipeline::forget_target lets it be taken again.
  TargetHandling handling = {};
  /// Nothing: a 3-D target's own pose or position and, for handling as a point, the point measured
  /// within a region or at a key point.
  std::optional<TargetEstimate> estimate = {};
  std::string_view fault = {};  ///< what its source knows to be wrong with it; empty: nothing
};

/// Whether a shape is rendered alone.
[[nodiscard]] bool is_rendered(const TargetShape& shape);

/// Throw InputError for a shape, a name or settings that can be right in no frame: what the
/// pipeline would say of it in each. Pixels of a region are checked with the image they are of.
void check_shape(const TargetShape& shape);
void check_target(const Target& target);

/// Throws InputError for a pose that is none, or more than max_target_distance away, or in the
/// camera: given in its frame, and nearer to it than DepthRenderer::near_plane.
void check_estimate(const TargetEstimate& estimate);

/// Where a handled target is at the frame's stamp, in the root link's frame.
struct HandledTarget {
  Source source = Source::lost;
  double age = 0;  ///< seconds since the last accepted estimate; infinite before the first
  std::optional<Eigen::Vector3d> position;        ///< metres; nothing if lost
  std::optional<Eigen::Quaterniond> orientation;  ///< nothing if lost, or handled as a point
  double sigma = 0;  ///< metres: along the position's most uncertain direction
};

/// What is said of a target. Views are valid until the pipeline's next call.
struct TargetReport {
  std::string_view name;
  std::optional<std::int64_t> stamp;  ///< of the frame that it was judged on, nanoseconds
  Verdict verdict = Verdict::unknown;
  std::string_view reason;  ///< one line, for verdict unknown; else empty

  /// Nothing where no pixels were judged. All but `point` are as the judge says them.
  std::optional<Judgement> judgement;
  std::optional<Eigen::Vector3d> point;  ///< of trusted depths only; root link's frame, metres

  std::optional<HandledTarget> handled;  ///< nothing without handling, or without stamps
  std::optional<Outcome> estimate;       ///< nothing where there was none
  bool wants_stamp = false;              ///< it would be handled, had the frame a stamp
};

}  // namespace penumbra
