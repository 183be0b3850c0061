// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/labels/image_space.hpp>
#include <penumbra/labels/labels.hpp>
#include <penumbra/labels/rule.hpp>
#include <penumbra/labels/scene_memory.hpp>
#include <penumbra/pipeline/attached_bodies-inl.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/pipeline.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/labelled_frame.hpp>
#include <penumbra/targets/target_judge.hpp>

namespace penumbra {

/// Renders the robot with what is attached to it and labels the depth image, in the configured
/// image space.
class FrameLabeller {
 public:
  /// Robot and rectification (null without lens distortion) must outlive this.
  FrameLabeller(const Robot& robot, const Camera& camera, const Rectification* rectification,
                const PipelineConfig& config);

  /// Renders the robot and labels the depth image. The result refers to `depth` and `poses`, and is
  /// valid until the next call.
  LabelledFrame label(const DepthView& depth, const PoseResult& poses);

  /// Forgets what earlier frames measured.
  void forget() {
    if (memory_) memory_->forget();
  }

  [[nodiscard]] const DepthRenderer& renderer() const { return *renderer_; }
  [[nodiscard]] const LabelRule& rule() const { return classifier_.rule(); }
  [[nodiscard]] const std::optional<UncoveredPixels>& uncovered() const { return uncovered_; }

  /// Returns whether depth images are rectified.
  [[nodiscard]] bool rectifies() const { return rectified_depth_.has_value(); }

  /// The pinhole projection for rendering, and the projection of the label image.
  [[nodiscard]] const Intrinsics& render_intrinsics() const { return render_intrinsics_; }
  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }

 private:
  FrameStatus check(LabelledFrame& frame);
  [[nodiscard]] LabelView unknown_labels() const;
  void add_reaches(LabelledImages& images, const VirtualDepthView& robot, const PoseResult& poses);
  LabelView without_trusted(const LabelView& labels);
  VirtualDepthView add(const VirtualDepthView& robot, std::span<const PlacedBody> bodies,
                       std::span<const Reach> reaches);
  LabelView classify(const VirtualDepthView& virtual_depth, const DepthView& measured,
                     ImageView<const std::uint16_t> known = {});

  Intrinsics render_intrinsics_;
  Intrinsics intrinsics_;
  std::unique_ptr<DepthRenderer> renderer_;
  AttachedBodies attached_;
  std::optional<RawImages> raw_images_;            // with distortion, ImageSpace::raw
  std::optional<RectifiedDepth> rectified_depth_;  // with distortion, ImageSpace::rectified
  std::optional<UncoveredPixels> uncovered_;       // with distortion
  Classifier classifier_;
  std::optional<SceneMemory> memory_;  // if the rule has fringe and memory
  bool has_depth_;
  Eigen::Vector2i depth_size_;  // of the camera's images, pixels
  labelling::Rule measured_;    // defines a measurement
  std::string message_;
  Image<std::uint8_t> labels_with_reaches_;
  std::vector<std::uint16_t> unplaced_;  // LabelledImages::unplaced
  Image<std::uint8_t> untrusted_;
  std::vector<std::uint16_t> no_depth_row_;  // all rows of an image (stride 0)
  std::vector<std::uint8_t> unknown_row_;
};

/// Returns the configured rule with its range cut to the camera's.
[[nodiscard]] LabelRule rule_of(const Camera& camera, const PipelineConfig& config);

}  // namespace penumbra
