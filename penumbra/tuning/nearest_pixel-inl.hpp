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
    int u, v;
  };
  /// No pixel is marked: infinite.
  [[nodiscard]] double distance(int u, int v) const;  ///< pixels
  [[nodiscard]] Pixel at(int u, int v) const {        ///< some pixel must be marked
    const std::int32_t index = nearest_(u, v);
    return {index % nearest_.width(), index / nearest_.width()};
  }

 private:
  [[nodiscard]] std::int64_t squared(int u, int v, std::int32_t index) const;
  void take(int u, int v, int from_u, int from_v);

  Image<std::int32_t> nearest_;  // v * width + u, or -1
};

}  // namespace penumbra::tuning
