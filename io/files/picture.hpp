// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Returns whether a pixel is of the robot's outline: with depth, next to one without.
[[nodiscard]] bool is_outline(ImageView<const float> virtual_depth, int u, int v);

/// Draws the robot's outline in a colour or another value of pixels.
template <typename T>
void draw_outline(ImageView<const float> virtual_depth, T value, Image<T>& image) {
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u)
      if (is_outline(virtual_depth, u, v)) image(u, v) = value;
}

/// Writes a line beside a square of its colour, the `line`-th of `lines` at the lower left.
void draw_legend(const std::string& text, Rgb8 color, int line, int lines, Image<Rgb8>& image);

}  // namespace penumbra::io
