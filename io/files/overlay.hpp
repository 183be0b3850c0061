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

/// The content of the augmented view. All images have one size.
struct OverlayInput {
  ImageView<const Rgb8> color;  ///< the scene; empty: depth is drawn in grey instead
  DepthView depth;              ///< used only without colour; may be empty
  LabelView labels;             ///< empty: no robot could be drawn; `message` says why
  std::int64_t index = 0;
  std::optional<std::int64_t> stamp;  ///< nanoseconds
  std::string_view message;           ///< drawn at the lower edge; may be empty
  bool pose_known = true;             ///< false: all labels are unknown
  std::size_t uncovered = 0;  ///< PixelCounts::uncovered: unknown in the image, not in its counts
};

/// Returns the colour of a label, distinguishable with any common colour blindness.
[[nodiscard]] Rgb8 label_color(Label label);

/// Returns the same colours by label, for label images; clear is black.
[[nodiscard]] std::span<const Rgb8> label_palette();

/// Draws the scene with labels, the robot's outline and a legend with each label's pixels. Scene
/// and labels must not both be empty. A message is cut after three lines. `out` gets their size;
/// its buffer is reused if the size stays the same.
void draw_overlay(const OverlayInput& input, Image<Rgb8>& out);

}  // namespace penumbra::io
