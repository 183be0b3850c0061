// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <penumbra/base/image.hpp>

namespace penumbra::tuning {

/// The nearest marked pixel of every pixel of an image.
class NearestPixels {
 public:
  /// `is_marked`: of a pixel (u, v). Two sweeps over the image (Danielsson 1980): off by less than
  /// a pixel in rare cases.
  template <typename Marked>
  NearestPixels(int width, int height, Marked&& is_marked) : nearest_(width, height) {
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        if (is_marked(u, v))
          nearest_(u, v) = {static_cast<std::int16_t>(u), static_cast<std::int16_t>(v)};
    sweep();
  }

  struct Pixel {
    std::int16_t u = -1, v = -1;
  };
  /// Returns the distance in pixels; infinite if no pixel is marked.
  [[nodiscard]] double distance(int u, int v) const;
  /// Requires a marked pixel.
  [[nodiscard]] Pixel at(int u, int v) const { return nearest_(u, v); }

 private:
  void sweep();
  void take(int u, int v, int from_u, int from_v);

  Image<Pixel> nearest_;
};

}  // namespace penumbra::tuning
