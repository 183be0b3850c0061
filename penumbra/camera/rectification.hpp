// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>

namespace penumbra {

/// The lens model reaches no pixel of the image.
class LensError : public InputError {
 public:
  using InputError::InputError;
};

/// Maps between a camera's raw, distorted image and a pinhole image that covers it, computed once.
/// Both maps take the nearest pixel: depths are never mixed.
///
/// The pinhole image covers every raw pixel whose ray the lens model reaches (inside
/// Distortion::max_radius()) within half_angle() of the optical axis. None of its pixels is larger
/// than a raw pixel in any direction, so the ray of raw_to_pinhole() is off by at most half a
/// pixel's diagonal (0.71 raw pixels). Without distortion, and inside that angle, it is the raw
/// image.
class Rectification {
 public:
  static constexpr std::int32_t no_pixel = -1;

  /// The most pixels of a pinhole image, or four times those of the raw image if that is more.
  static constexpr std::size_t max_pixels = std::size_t{1} << 25;

  /// The largest scale of the pinhole image relative to the raw focal length.
  static constexpr double max_stretch = 4;

  /// Covers rays up to `max_half_angle` (radians, below 90 degrees) from the optical axis, or up to
  /// a smaller angle, see half_angle(), if the pinhole image would exceed max_pixels,
  /// Intrinsics::max_size or max_stretch. Pinhole pixels are `fineness` times smaller than needed.
  /// Throws LensError if the lens model reaches no pixel of the image.
  explicit Rectification(const Camera& raw, double max_half_angle = 1.3, double fineness = 1);

  [[nodiscard]] const Intrinsics& pinhole() const { return pinhole_; }

  /// Rays farther than this from the optical axis, radians, are not covered.
  [[nodiscard]] double half_angle() const { return half_angle_; }

  /// For every raw pixel the index v * width + u of its pinhole pixel, or no_pixel if the lens
  /// model does not reach it or the pinhole image does not cover it: such pixels are unknown.
  [[nodiscard]] ImageView<const std::int32_t> raw_to_pinhole() const { return to_pinhole_.view(); }

  /// For every pinhole pixel the index v * width + u of its raw pixel, or no_pixel.
  [[nodiscard]] ImageView<const std::int32_t> pinhole_to_raw() const { return to_raw_.view(); }

  /// Marks in `raw`, a mask of the raw image's size, exactly the tiles with a raw pixel whose
  /// pinhole pixel lies in a marked tile. The cost depends on the marked tiles. Allocates nothing.
  void touched_raw(const TileMask& pinhole, TileMask& raw) const;

 private:
  struct RawTiles {
    std::uint32_t row;
    std::uint64_t columns;  // as in TileMask::rows
  };

  struct Plan;

  Rectification(const Camera& raw, const Plan& plan);
  [[nodiscard]] static Plan plan(const Camera& raw, double max_half_angle, double fineness);
  void map_pinhole(const Camera& raw);
  void list_tiles();

  Intrinsics pinhole_;
  double half_angle_;
  Image<std::int32_t> to_pinhole_;
  Image<std::int32_t> to_raw_;
  std::vector<std::uint32_t> first_;  // of pinhole tile row * 64 + column, in tiles_; and the end
  std::vector<RawTiles> tiles_;
};

/// Copies pixels through a map: out(u, v) = in[map(u, v)], or `outside` where the map has no pixel.
/// `out` must have the map's size and `in` that of the image the map's indices refer to.
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
