// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <penumbra/base/image.hpp>

namespace penumbra::tuning {

/// The nearest marked pixel of every pixel of an image.
class NearestPixels {
 public:
  /// Two sweeps over the image (Danielsson 1980): off by less than a pixel in rare cases.
  explicit NearestPixels(const Image<std::uint8_t>& marked);

  struct Pixel {
    std::int16_t u = -1, v = -1;
  };
  /// Returns the distance in pixels; infinite if no pixel is marked.
  [[nodiscard]] double distance(int u, int v) const;
  /// Requires a marked pixel.
  [[nodiscard]] Pixel at(int u, int v) const { return nearest_(u, v); }

 private:
  void take(int u, int v, int from_u, int from_v);

  Image<Pixel> nearest_;
};

}  // namespace penumbra::tuning
