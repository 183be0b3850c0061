// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra {

/// Which image VDI, labels and links are given in. Without lens distortion both are the same.
enum class ImageSpace {
  raw,       ///< the camera's image as it comes
  rectified  ///< the pinhole image that covers it: Pipeline::intrinsics()
};

struct PipelineConfig {
  Backend backend = Backend::cpu;
  RendererOptions renderer;  ///< threads and SIMD target of the cpu backend, device of gl
  LabelRule rule;            ///< its range and the camera's both apply
  ImageSpace image = ImageSpace::raw;
  std::string camera_parent;  ///< link that the camera sits on; empty: the root
  /// Pose of the optical frame in that link's frame, metres.
  Eigen::Isometry3d T_parent_camera = Eigen::Isometry3d::Identity();
  /// How long frames are kept for targets of an earlier stamp, seconds up to max_target_history; 0:
  /// not at all, and such targets are unknown. It costs time and memory: docs/targets.md.
  double target_history = 0.0;

  static constexpr double max_target_history = 60.0;
};

/// The whole method, one call per frame: poses, virtual depth, labels, targets. Allocates nothing
/// per frame after the first of its kind. One instance serves one thread at a time.
class Pipeline {
 public:
  /// Throws InputError for a robot of which nothing is drawn, a camera parent that is no link, a
  /// camera pose that is no rigid transform or over 1000 km away, and what Camera, LabelRule and
  /// make_depth_renderer refuse.
  Pipeline(Robot robot, const Camera& camera, const PipelineConfig& config = {});
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  /// Judges one frame; the report is valid until the next call. Whatever is wrong with the frame is
  /// its status: an image of another frame never shows. Throws InputError for doubts of what is no
  /// link. Throws DeviceError if the graphics device fails.
  const FrameReport& process(const Frame& frame);

  /// Forgets a target's verdict, extent and track: the name stands for something new. All of them,
  /// and the kept frames: a new sequence begins. A stamp more than 1 s before the newest one does
  /// so, too.
  void forget_target(std::string_view name);
  void forget_targets();

  [[nodiscard]] const Robot& robot() const;
  [[nodiscard]] const RendererInfo& renderer() const;
  [[nodiscard]] std::size_t triangle_count() const;

  /// The rule that labels are made by: the configuration's, its range cut to the camera's.
  [[nodiscard]] const LabelRule& rule() const;

  /// Size and projection of the report's images; in the raw image of a lens with distortion the
  /// projection is that of its pinhole part.
  [[nodiscard]] const Intrinsics& intrinsics() const;

  /// Brings images of the camera to the report's; null where the report's images are the camera's.
  [[nodiscard]] const Rectification* rectification() const;

  /// Links whose geometry could not be read (RobotOptions::allow_missing_meshes).
  [[nodiscard]] std::span<const std::string> missing_links() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra
