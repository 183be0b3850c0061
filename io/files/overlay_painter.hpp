// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>
#include <penumbra/pipeline/frame.hpp>
#include <penumbra/pipeline/target.hpp>
#include <penumbra/robot/robot.hpp>

#include <io/files/png.hpp>
#include <io/files/target_overlay.hpp>

namespace penumbra::io {

/// What overlays need to show a frame's targets.
struct ShownTargets {
  std::span<const Target> targets;
  const Robot& robot;
  const Camera& camera;  ///< of the report's images
};

/// What overlays are drawn over: the camera's images.
struct ShownImages {
  DepthView depth;              ///< may be empty
  ImageView<const Rgb8> color;  ///< empty: depth is shown in its place
};

/// Draws the augmented view of a frame: its labels and targets over the colour image, or over depth
/// where there is none.
class OverlayPainter {
 public:
  /// `rectification` brings recorded images to the report's; null where they fit, else it must
  /// outlive this.
  explicit OverlayPainter(const Rectification* rectification) : rectification_(rectification) {}

  /// Valid until the next call.
  ImageView<const Rgb8> draw(const FrameReport& report, const ShownImages& images,
                             const ShownTargets& targets);

  /// The camera's colour image as the report's images are; valid until the next call.
  ImageView<const Rgb8> seen_color(ImageView<const Rgb8> raw);

 private:
  template <typename T>
  ImageView<const T> seen(ImageView<const T> raw, Image<T>& rectified);
  Image<std::uint16_t>& depth_of(const ImageView<const std::uint16_t>&) { return millimetres_; }
  Image<float>& depth_of(const ImageView<const float>&) { return metres_; }

  const Rectification* rectification_;
  Image<Rgb8> color_;
  Image<std::uint16_t> millimetres_;
  Image<float> metres_;
  Image<Rgb8> overlay_;
  TargetOverlay target_overlay_;
};

}  // namespace penumbra::io
