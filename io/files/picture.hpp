// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Draws the robot's outline: pixels with depth next to pixels without.
void draw_outline(ImageView<const float> virtual_depth, Rgb8 color, Image<Rgb8>& image);

/// Writes a line beside a square of its colour, the `line`-th of `lines` at the lower left.
void draw_legend(const std::string& text, Rgb8 color, int line, int lines, Image<Rgb8>& image);

}  // namespace penumbra::io
