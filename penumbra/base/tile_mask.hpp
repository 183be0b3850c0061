// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace penumbra {

/// The tiles of an image that are not empty, so that the cost of later stages depends on touched
/// pixels and not on the image's size. Bit i of rows[j] is the tile with the first pixel
/// (i * tile_width, j * tile_height); the last tile of a row or column may extend past the image.
struct TileMask {
  static constexpr int tile_height = 8;

  int width = 0;        ///< of the image, pixels
  int height = 0;       ///< of the image, pixels
  int tile_width = 32;  ///< pixels; a power of two so that at most 64 tiles span the image
  std::vector<std::uint64_t> rows;

  TileMask() = default;
  TileMask(int image_width, int image_height) : width(image_width), height(image_height) {
    while (tile_width * 64 < image_width) tile_width *= 2;
    rows.assign(static_cast<std::size_t>((image_height + tile_height - 1) / tile_height), 0);
  }

  /// Marks every tile with a pixel of [u0, u1] x [v0, v1], bounds inside the image.
  void mark(int u0, int v0, int u1, int v1) {
    const std::uint64_t upto = ~std::uint64_t{0} >> (63 - u1 / tile_width);
    const std::uint64_t bits = upto & (~std::uint64_t{0} << (u0 / tile_width));
    for (int j = v0 / tile_height; j <= v1 / tile_height; ++j)
      rows[static_cast<std::size_t>(j)] |= bits;
  }

  /// Calls f(u0, u1, v0, v1) for every run of marked tiles in a tile row: the pixels u0 <= u < u1,
  /// v0 <= v < v1, cut to the image.
  template <typename F>
  void for_each_span(F&& f) const {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const int v0 = static_cast<int>(j) * tile_height;
      const int v1 = v0 + tile_height < height ? v0 + tile_height : height;
      for (std::uint64_t bits = rows[j]; bits != 0;) {
        const int first = std::countr_zero(bits);
        const int count = std::countr_one(bits >> first);
        const int u1 = (first + count) * tile_width;
        f(first * tile_width, u1 < width ? u1 : width, v0, v1);
        bits = first + count >= 64 ? 0 : bits & (~std::uint64_t{0} << (first + count));
      }
    }
  }
};

}  // namespace penumbra
