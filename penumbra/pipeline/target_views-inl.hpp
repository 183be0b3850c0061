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

/// T_root_frame in a frame whose poses are known. Throws InputError for a link that is none, or
/// that is doubted.
[[nodiscard]] Eigen::Isometry3d pose_of(const LinkFrame& frame, const PoseResult& poses,
                                        const Robot& robot);

/// Renders objects alone: each mesh by a renderer of its own that is kept as long as it is in use,
/// boxes, whose size may change with every frame, by the rays of their pixels.
class ObjectRenderers {
 public:
  /// Renderers that are kept; where more are wanted in one frame, they are made again and again.
  static constexpr std::size_t max_kept = 32;

  /// `rectification`: of raw images with lens distortion; else null. Must outlive this.
  ObjectRenderers(const Intrinsics& intrinsics, Backend backend, const RendererOptions& options,
                  const Rectification* rectification);
  ~ObjectRenderers();

  /// Depth of a box or mesh; valid until the next call. Throws InputError for a mesh that cannot be
  /// drawn.
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

/// Brings targets' shapes to the image.
class TargetViews {
 public:
  /// `camera`: of the images that are judged, `rule`: that of their labels, `rectification`: of raw
  /// images with lens distortion; else null. All but the rule must outlive this.
  TargetViews(const Robot& robot, const Camera& camera, ObjectRenderers& renderers,
              const LabelRule& rule, const Rectification* rectification);

  /// The target's region and expected depth; nothing where its shape lies outside of the camera's
  /// view. Valid until the next call. Throws InputError for a shape that is none.
  [[nodiscard]] std::optional<TargetView> view(const Target& target, const LabelledFrame& frame);

  /// Where a point in the optical frame is seen, pixels; nothing where the camera cannot see it.
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
  /// Of a cone about the optical axis: rays beyond it are of the raw image, but not of the pinhole
  /// image by which it is drawn. Nothing where the pinhole image covers the raw one.
  std::optional<double> drawn_half_angle_;
};

}  // namespace penumbra
