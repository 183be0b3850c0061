// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/label_work-inl.hpp>
#include <penumbra/pipeline/image_space-inl.hpp>
#include <penumbra/pipeline/labelled_frame-inl.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Returns T_root_frame; the poses must be known. Throws InputError for an unknown or uncertain
/// link.
[[nodiscard]] Eigen::Isometry3d pose_of(const ReferenceFrame& frame, const PoseResult& poses,
                                        const Robot& robot);

/// Renders objects alone. Each mesh has its own renderer, which is cached; boxes, whose size may
/// change with every frame, are ray cast.
class ObjectRenderers {
 public:
  /// Cached renderers; more meshes in one frame are prepared again each time.
  static constexpr std::size_t max_kept = 32;

  /// `rectification`: for raw images with lens distortion, else null. Must outlive this.
  ObjectRenderers(const Intrinsics& intrinsics, Backend backend, const RendererOptions& options,
                  const Rectification* rectification);
  ~ObjectRenderers();

  /// Returns the depth of a box or mesh; valid until the next call. Throws InputError for an
  /// invalid mesh.
  VirtualDepthView box(const Eigen::Vector3d& size, const Eigen::Isometry3d& T_camera_box);
  VirtualDepthView mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                        const Eigen::Isometry3d& T_camera_mesh);

 private:
  struct Kept;
  VirtualDepthView render(Kept& kept, const Eigen::Isometry3d& T_camera_object);
  VirtualDepthView in_image(const VirtualDepthView& rendered);
  void clear_box();
  Kept& place();

  Intrinsics intrinsics_;
  Backend backend_;
  RendererOptions options_;
  const Rectification* rectification_;
  std::optional<RawImages> raw_images_;  // made with the first object
  Image<float> box_depth_;               // made with the first box
  Image<std::uint16_t> box_links_;       // zeros
  TileMask box_touched_;
  std::vector<std::unique_ptr<Kept>> kept_;
  std::size_t uses_ = 0;
};

/// Projects targets' shapes into the image.
class TargetViews {
 public:
  /// `camera` and `rule`: of the judged images. `rectification`: for raw images with lens
  /// distortion, else null. Robot, camera and renderers must outlive this.
  TargetViews(const Robot& robot, const Camera& camera, ObjectRenderers& renderers,
              const LabelRule& rule, const Rectification* rectification);

  /// Returns the target's region and expected depth; null if its shape is outside the view. Valid
  /// until the next call. Throws InputError for an invalid shape.
  [[nodiscard]] std::optional<TargetView> view(const Target& target, const LabelledFrame& frame);

  /// Returns the pixel of a point in the optical frame; null if the camera cannot see it.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p) const;

 private:
  struct Builder;

  void check_is_drawn(const Eigen::Vector3d& middle, double radius) const;
  [[nodiscard]] Eigen::Matrix2d pixels_per_metre(const Eigen::Vector2d& ray, double depth) const;
  [[nodiscard]] PixelEllipse ellipse_of(const Eigen::Vector3d& p, double radius) const;

  const Robot& robot_;
  const Camera& camera_;
  ObjectRenderers& renderers_;
  labelling::Rule rule_;
  /// Half angle of the cone about the optical axis that the pinhole image covers; rays outside it
  /// cannot be rendered. Null if the pinhole image covers the whole raw image.
  std::optional<double> drawn_half_angle_;
};

}  // namespace penumbra
