// SPDX-License-Identifier: Apache-2.0
// One camera's prediction of targets, for one pose of the robot at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/image_space.hpp>
#include <penumbra/planning/clearance-inl.hpp>
#include <penumbra/planning/look_ahead.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/near_plane_check.hpp>
#include <penumbra/targets/object_renderers.hpp>
#include <penumbra/targets/region_spans.hpp>
#include <penumbra/targets/target_views.hpp>

namespace penumbra::planning {

/// A target in space at the start of a motion.
struct AnchoredTarget {
  ForecastTarget start;  ///< its shape is not in the camera's frame
  /// Of a region or key point whose depth is known: its outline in the root's frame, metres.
  std::vector<Eigen::Vector3d> outline = {};
  Eigen::Isometry3d T_root_camera = Eigen::Isometry3d::Identity();  ///< of the first camera
};

/// Fixes a target in space as a camera on a given pose gives it.
[[nodiscard]] AnchoredTarget anchored(const ForecastTarget& target, const Camera& camera,
                                      const Eigen::Isometry3d& T_root_camera);

/// Where something is in the image.
struct SeenBody {
  Eigen::Isometry3d T_camera_body;
  PixelRectangle pixels;  ///< in which it may be seen
};

/// A time of the motion.
struct Sample {
  double time = 0.0;                    ///< seconds
  std::vector<Prediction> predictions;  ///< by target
  std::vector<PixelRectangle> targets;  ///< pixels of each, empty if it is not in the image
  std::vector<SeenBody> bodies;         ///< links, then attached bodies; empty if not known
};

/// Judges targets in one camera, from renders of the robot next to each.
class CameraPredictor {
 public:
  /// Robot and targets must outlive this. `start`: what links carry, and links whose pose is not
  /// known. `clearance`: as LookAheadConfig.
  CameraPredictor(const Robot& robot, const ForecastCamera& camera,
                  std::span<const AnchoredTarget> targets, const RobotPose& start, int clearance);

  /// Begins anew with other targets. Returns false, and does nothing, if other things are carried.
  [[nodiscard]] bool set(std::span<const AnchoredTarget> targets, const RobotPose& start);

  /// Judges all targets at a time of the motion, with the robot at `positions`.
  [[nodiscard]] Sample at(double time, std::span<const double> positions);

  /// Returns the pixels by which a part of a body moves at most from one sample to another.
  [[nodiscard]] double motion_of(std::size_t body, const Sample& a, const Sample& b) const;

 private:
  void place_bodies(const PoseResult& poses, Sample& sample);
  const SeenTarget& show(std::size_t target, const PoseResult& poses, double time);
  void fill(std::size_t target, const PoseResult& poses, SeenTarget& shown);
  void set_extent(const TargetView& view, double depth, SeenTarget& shown);
  void move(std::size_t target, double time);
  [[nodiscard]] Prediction judge(std::size_t target, bool is_near);
  const Robot& robot_;
  std::span<const AnchoredTarget> anchored_;
  std::vector<Target> targets_;           // at the sample's time
  std::vector<Eigen::Vector3d> outline_;  // of the target that was moved last
  std::optional<Rectification> rectification_;
  Camera camera_;  // of the rectified images
  int clearance_;
  double free_;  // the clearance of a target that nothing is near to
  LabelRule rule_;
  labelling::Rule label_rule_;
  RobotPose pose_;
  std::vector<AttachedBody> carried_;
  PoseStage poses_;
  std::vector<std::string> names_;           // of links, then attached bodies
  std::vector<Eigen::AlignedBox3d> bounds_;  // of each in its frame; empty if it is not drawn
  std::unique_ptr<DepthRenderer> renderer_;
  NearPlaneCheck near_plane_;
  std::vector<Eigen::Isometry3d> T_camera_body_;
  std::string unknown_reason_;  // why what seems to be seen may be hidden; empty: it is seen
  std::string always_unknown_;
  ObjectRenderers objects_;
  TargetViews views_;
  SeenPixels seen_pixels_;
  RegionSpans spans_;
  std::vector<SeenTarget> shown_;  // by target
  LabelledImages images_;          // the robot
  ExtentTally tally_;
  Clearance clearance_of_;
};

}  // namespace penumbra::planning
