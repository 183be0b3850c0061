// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/rectification.hpp>

#include <apps/penumbra/run_output.hpp>
#include <io/png.hpp>
#include <io/target_overlay.hpp>

namespace penumbra::app {

/// Draws the augmented view of a frame: its labels and targets over the colour image, or over depth
/// where there is none.
class OverlayPainter {
 public:
  /// `rectification` brings recorded images to the report's; null where they fit, else it must
  /// outlive this.
  explicit OverlayPainter(const Rectification* rectification) : rectification_(rectification) {}

  /// Valid until the next call.
  ImageView<const io::Rgb8> draw(const FrameReport& report, const io::FrameData& frame,
                                 const ShownTargets& targets);

 private:
  template <typename T>
  ImageView<const T> seen(const Image<T>& raw, Image<T>& rectified);
  Image<std::uint16_t>& depth_of(const Image<std::uint16_t>&) { return millimetres_; }
  Image<float>& depth_of(const Image<float>&) { return metres_; }

  const Rectification* rectification_;
  Image<io::Rgb8> color_;
  Image<std::uint16_t> millimetres_;
  Image<float> metres_;
  Image<io::Rgb8> overlay_;
  io::TargetOverlay target_overlay_;
};

}  // namespace penumbra::app
