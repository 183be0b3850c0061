// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/robot/robot.hpp>
#include <penumbra/targets/target.hpp>

#include <io/files/png.hpp>
#include <io/files/target_overlay.hpp>

namespace penumbra::io {

/// The camera's images, which overlays are drawn on.
struct ShownImages {
  DepthView depth;              ///< may be empty
  ImageView<const Rgb8> color;  ///< empty: depth is shown instead
};

/// Returns the colour of a label, distinguishable with any common colour blindness.
[[nodiscard]] Rgb8 label_color(Label label);

/// Returns the same colours by label, for label images; clear is black.
[[nodiscard]] std::span<const Rgb8> label_palette();

/// Draws the scene with labels, the robot's outline, and a legend with each label's pixels. Images
/// have the geometry of the report's; at least one of them or the labels must not be empty. A
/// message is cut after three lines. `out` gets their size; its buffer is reused if the size stays
/// the same.
void draw_overlay(const FrameReport& report, const ShownImages& images, Image<Rgb8>& out);

/// Draws the augmented view of a frame: labels and targets over the colour image, or over depth.
class OverlayPainter {
 public:
  /// `camera`: of the report's images; `rectification` converts recorded images to their geometry,
  /// null if they have it already. It must outlive this.
  OverlayPainter(Robot robot, Camera camera, const Rectification* rectification)
      : robot_(std::move(robot)), camera_(std::move(camera)), rectification_(rectification) {}

  /// The result is valid until the next call.
  ImageView<const Rgb8> draw(const Frame& frame, const FrameReport& report);

  /// Returns the colour image in the geometry of the report's images; valid until the next call.
  ImageView<const Rgb8> seen_color(ImageView<const Rgb8> raw);

 private:
  Image<std::uint16_t>& depth_of(const ImageView<const std::uint16_t>&) { return millimetres_; }
  Image<float>& depth_of(const ImageView<const float>&) { return metres_; }

  Robot robot_;
  Camera camera_;
  const Rectification* rectification_;
  Image<Rgb8> color_;
  Image<std::uint16_t> millimetres_;
  Image<float> metres_;
  Image<Rgb8> overlay_;
  TargetOverlay target_overlay_;
};

}  // namespace penumbra::io
