// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/files/bitmap_font.hpp>
#include <io/files/picture.hpp>

namespace penumbra::io {
namespace {

constexpr Rgb8 text_color{255, 255, 255};
constexpr Rgb8 shadow_color{0, 0, 0};
constexpr int rows_per_letter = 360;  // image rows for which letters grow by their own size

}  // namespace

bool is_outline(ImageView<const float> depth, int u, int v) {
  const auto is_robot = [&](int x, int y) { return depth(x, y) > 0.0f; };
  return is_robot(u, v) && ((u > 0 && !is_robot(u - 1, v)) || (v > 0 && !is_robot(u, v - 1)) ||
                            (u + 1 < depth.width && !is_robot(u + 1, v)) ||
                            (v + 1 < depth.height && !is_robot(u, v + 1)));
}

void draw_legend(const std::string& text, Rgb8 color, int line, int lines, Image<Rgb8>& image) {
  const int scale = std::max(1, image.height() / rows_per_letter);
  const int size = BitmapFont::height * scale, left = 2 * size;
  const int top = image.height() - (lines - line) * (size + scale) - size;
  BitmapFont::fill(size / 2, top, size - scale, color, image);
  for (const int shift : {-1, 1})
    for (const int other : {-1, 1})
      BitmapFont::draw(text, left + shift, top + other, scale, shadow_color, image);
  BitmapFont::draw(text, left, top, scale, text_color, image);
}

}  // namespace penumbra::io
