// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <penumbra/base/image.hpp>
#include <penumbra/base/tile_mask.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

/// Maps between a camera's raw, distorted image and a pinhole image that covers it, computed once.
/// Both ways take the nearest pixel: depths are never mixed.
class Rectification {
 public:
  static constexpr std::int32_t no_pixel = -1;

  /// Chooses the pinhole image so that it covers every raw pixel that the lens model reaches (up to
  /// `max_half_angle`, radians, and Intrinsics::max_size), at no less than the raw resolution.
  explicit Rectification(const Camera& raw, double max_half_angle = 1.3);

  [[nodiscard]] const Intrinsics& pinhole() const { return pinhole_; }

  /// For every raw pixel the index v * width + u of its pinhole pixel, or no_pixel where the lens
  /// model does not reach or the pinhole image does not cover: such pixels are unknown.
  [[nodiscard]] ImageView<const std::int32_t> raw_to_pinhole() const { return to_pinhole_.view(); }

  /// For every pinhole pixel the index v * width + u of the raw pixel seen there, or no_pixel.
  [[nodiscard]] ImageView<const std::int32_t> pinhole_to_raw() const { return to_raw_.view(); }

  /// Raw tiles that hold a pixel of the marked pinhole tiles.
  void touched_raw(const TileMask& pinhole, TileMask& raw) const;

 private:
  Intrinsics pinhole_;
  Image<std::int32_t> to_pinhole_;
  Image<std::int32_t> to_raw_;
};

/// Copies pixels through a map: out(u, v) = in[map(u, v)], or `outside` where the map has no pixel.
/// `out` must have the map's size and `in` no gaps that the map does not know.
template <typename T>
void remap(ImageView<const std::int32_t> map, ImageView<const T> in, T outside, ImageView<T> out) {
  for (int v = 0; v < map.height; ++v) {
    for (int u = 0; u < map.width; ++u) {
      const std::int32_t i = map(u, v);
      out(u, v) = i < 0 ? outside : in(i % in.width, i / in.width);
    }
  }
}

}  // namespace penumbra
