// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/cloud/scan.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// The image space of virtual depth, labels and links. Both are the same without lens distortion.
enum class ImageSpace {
  raw,       ///< the camera's image
  rectified  ///< the pinhole image that covers it: Pipeline::intrinsics()
};

struct PipelineConfig {
  Backend backend = Backend::cpu;
  RendererOptions renderer;  ///< threads and SIMD target of the cpu backend, device of gl
  LabelRule rule;            ///< its range is cut to the camera's
  ImageSpace image = ImageSpace::raw;
  /// False: the camera measures no depth. Frames without a depth image are then ok, the robot's
  /// pixels are unknown, and verdicts come from the model alone: from what the robot hides of
  /// targets whose depth is known.
  bool has_depth = true;
  /// Seconds for which frames are stored for targets of an earlier stamp, up to max_target_history.
  /// 0: no storage, and such targets are unknown. Costs time and memory: docs/targets.md.
  double target_history = 0.0;

  static constexpr double max_target_history = 60.0;
};

class FrameJudge;

/// The whole method, one call per frame: poses, virtual depth, labels, targets. After the first of
/// its kind, a frame allocates only the names and reasons of its targets' reports. One instance
/// serves one thread at a time.
class Pipeline {
 public:
  /// Throws InputError for a robot without geometry, an unknown camera parent, a camera pose that
  /// is missing, not rigid or over 1000 km away, and as Camera, LabelRule and make_depth_renderer
  /// do.
  Pipeline(Robot robot, const Camera& camera, const PipelineConfig& config = {});
  /// Of a sensor of points: its frames have scans. Targets are 3-D boxes and points, judged on the
  /// rays that meet them at the scan's begin; what has no measured ray, or is of a cloud without
  /// rays, is unknown. In targets and reports, the camera is the points' frame. Throws InputError
  /// for a robot without geometry, an unknown parent, a pose that is not rigid, and as
  /// CloudLabeller.
  Pipeline(const Robot& robot, const CloudConfig& config);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  /// Judges one frame; the report is valid until the next call. Faults of the frame are its status;
  /// images of an earlier frame are never returned. Throws InputError for uncertain_links that do
  /// not exist, and DeviceError if the graphics device fails.
  /// `forecasts`: TargetReport::forecast of each target; empty: there are none.
  const FrameReport& process(const Frame& frame, std::span<const Forecast> forecasts = {});

  /// Returns a target of the last frame as a body that `link` carries from that frame on: a 3-D box
  /// or mesh, or the ball of a point. To be called when the gripper closes; put the body into
  /// RobotPose::attached of the following frames or into Attachments. Its pose is the target's
  /// handled pose or, without handling, the pose of its shape. Throws InputError if that pose, the
  /// link's or the robot's is not known, and for a target that was not in the last frame or is no
  /// 3-D shape.
  [[nodiscard]] AttachedBody attach_target(const Target& target, std::string_view link) const;

  /// Forgets a target's verdict, extent and track, for a name that now means another object; or all
  /// of them together with the stored frames and what is known of the scene, for a new sequence. A
  /// stamp more than 1 s before the newest one also forgets all.
  void forget_target(std::string_view name);
  void forget_targets();

  [[nodiscard]] const Robot& robot() const;
  /// Links with unreadable geometry (RobotOptions::allow_missing_meshes).
  [[nodiscard]] std::span<const std::string> missing_links() const;

  /// Labels scans by another rule from now on. Throws InputError for an invalid one, and
  /// std::logic_error for a camera.
  void set_rule(const CloudRule& rule);

  // Of a camera; throw std::logic_error for a sensor of points:
  [[nodiscard]] const RendererInfo& renderer() const;
  [[nodiscard]] std::size_t triangle_count() const;

  /// The configured rule with its range cut to the camera's.
  [[nodiscard]] const LabelRule& rule() const;

  /// Returns the camera of the report's images: without distortion if they are rectified.
  [[nodiscard]] Camera report_camera() const;

  /// Size and projection of the report's images; for a raw image with distortion, the projection of
  /// the lens's pinhole part.
  [[nodiscard]] const Intrinsics& intrinsics() const;

  /// Maps the camera's images to the report's; null if they are the same.
  [[nodiscard]] const Rectification* rectification() const;

 private:
  struct State;
  Pipeline(Robot robot, const std::string& sensor_parent, const Eigen::Isometry3d& T_parent_sensor,
           std::unique_ptr<FrameJudge> scans);

  std::unique_ptr<State> state_;
};

}  // namespace penumbra
