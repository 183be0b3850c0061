// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <penumbra/base/image.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// A font of fixed width with letters of 5 x 7 pixels, times a whole scale.
struct BitmapFont {
  static constexpr int advance = 6;  ///< pixels from one letter to the next, at scale 1
  static constexpr int height = 9;   ///< pixels of a line with its descenders, at scale 1

  /// Draws one line with its top left corner at (u, v), cut to the image. Bytes that are not
  /// printable ASCII become question marks.
  static void draw(std::string_view text, int u, int v, int scale, Rgb8 color, Image<Rgb8>& image);

  /// Fills a square of `size` pixels with its top left corner at (u, v), cut to the image.
  static void fill(int u, int v, int size, Rgb8 color, Image<Rgb8>& image);
};

}  // namespace penumbra::io
