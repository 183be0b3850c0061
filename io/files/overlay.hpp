// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <penumbra/base/image.hpp>
#include <penumbra/labels/labels.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// What the augmented view shows. All images that are given have one size.
struct OverlayInput {
  ImageView<const Rgb8> color;  ///< the scene; empty: depth is drawn in grey instead
  DepthView depth;              ///< used only without colour; may be empty
  LabelView labels;             ///< empty: no robot could be drawn; `message` says why
  std::int64_t index = 0;
  std::optional<std::int64_t> stamp;  ///< nanoseconds
  std::string_view message;   ///< drawn at the lower edge, such as what is wrong; may be empty
  bool pose_known = true;     ///< false: labels say nothing of the robot, all are unknown
  std::size_t uncovered = 0;  ///< PixelCounts::uncovered: unknown in the image, not in its counts
};

/// The colour that stands for a label; told apart by people with any common colour blindness.
[[nodiscard]] Rgb8 label_color(Label label);

/// Of label images: the same colours, by label; clear is black.
[[nodiscard]] std::span<const Rgb8> label_palette();

/// Draws the scene with labels over it, the robot's outline and a legend with each label's pixels.
/// One of them must not be empty. A message is cut after three lines. `out` gets their size; its
/// buffer is kept where the size stays.
void draw_overlay(const OverlayInput& input, Image<Rgb8>& out);

}  // namespace penumbra::io
