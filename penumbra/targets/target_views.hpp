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
#include <penumbra/labels/rule.hpp>
#include <penumbra/poses/pose_stage.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/object_renderers.hpp>
#include <penumbra/targets/target.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Returns T_root_frame; the poses must be known. Throws InputError for an unknown or uncertain
/// link.
[[nodiscard]] Eigen::Isometry3d pose_of(const ReferenceFrame& frame, const PoseResult& poses,
                                        const Robot& robot);

/// Returns the pixel of a point in the optical frame; null if the camera cannot see it: it is
/// outside the lens model, or less than DepthRenderer::near_plane before the camera.
[[nodiscard]] std::optional<Eigen::Vector2d> pixel_of(const Camera& camera,
                                                      const Eigen::Vector3d& p);

/// Projects targets' shapes into the image.
class TargetViews {
 public:
  /// `camera` and `rule`: of the judged images. `rectification`: for raw images with lens
  /// distortion, else null. Robot, camera and renderers must outlive this.
  TargetViews(const Robot& robot, const Camera& camera, ObjectRenderers& renderers,
              const LabelRule& rule, const Rectification* rectification);

  /// Returns the target's region and expected depth; null if its shape is outside the view. Valid
  /// until the next call. Throws InputError for an invalid shape.
  [[nodiscard]] std::optional<TargetView> view(const Target& target, const LabelledImages& images,
                                               const PoseResult& poses);

  /// Returns pixel_of() the camera.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p) const {
    return pixel_of(camera_, p);
  }

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
