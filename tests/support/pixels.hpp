// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

/// The pixels of a window row by row, for a range-based loop.
class PixelRange {
 public:
  struct Pixel {
    int u, v;
  };
  struct Iterator {
    Pixel at;
    int u0, u1;

    Pixel operator*() const { return at; }
    void operator++() {
      if (++at.u == u1) at = {u0, at.v + 1};
    }
    bool operator!=(int v) const { return at.v < v; }
  };

  PixelRange(int u0, int v0, int u1, int v1) : first_{{u0, v0}, u0, u1}, v1_(u0 < u1 ? v1 : v0) {}
  [[nodiscard]] Iterator begin() const { return first_; }
  [[nodiscard]] int end() const { return v1_; }

 private:
  Iterator first_;
  int v1_;
};

/// Returns the pixels of [u0, u1) x [v0, v1).
inline PixelRange each_pixel(int u0, int v0, int u1, int v1) { return {u0, v0, u1, v1}; }

/// Returns all pixels of an image, a view or a camera.
template <typename Image>
PixelRange each_pixel(const Image& image) {
  if constexpr (requires { image.width(); })
    return {0, 0, image.width(), image.height()};
  else
    return {0, 0, image.width, image.height};
}

/// A copy of a view.
template <typename T>
[[nodiscard]] std::vector<T> pixels_of(ImageView<const T> view) {
  std::vector<T> pixels;
  for (int v = 0; v < view.height; ++v)
    pixels.insert(pixels.end(), view.row(v), view.row(v) + view.width);
  return pixels;
}

/// 0 where nothing is measured.
[[nodiscard]] inline Image<std::uint16_t> to_millimetres(const Image<float>& metres) {
  Image<std::uint16_t> image(metres.width(), metres.height());
  std::transform(metres.data(), metres.data() + metres.size(), image.data(), [](float z) {
    return z > 0.0F && z < 65.0F ? std::uint16_t(std::lround(1e3F * z)) : std::uint16_t{0};
  });
  return image;
}

}  // namespace penumbra::test
