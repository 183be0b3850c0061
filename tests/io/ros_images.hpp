// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files.hpp"
#include "mini_png.hpp"
#include "ros_rvl.hpp"

#include <random>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

inline std::vector<std::byte> bytes_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

/// Surfaces with noise and holes.
inline Image<std::uint16_t> depth_image(int width, int height, std::mt19937_64& random) {
  Image<std::uint16_t> image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      image(u, v) = (u / 5 + v / 3) % 4 == 0
                        ? std::uint16_t{0}
                        : static_cast<std::uint16_t>(700 + 30 * (u / 7) + random() % 9);
  return image;
}

/// Data of the transport compressedDepth: parameters, then PNG or, with its size, RVL.
inline std::vector<std::byte> compressed_depth(const Image<std::uint16_t>& image, bool rvl, float a,
                                               float b) {
  const mini_png::Format format{static_cast<std::uint32_t>(image.width()),
                                static_cast<std::uint32_t>(image.height()), 16, 0, false};
  const std::string head = raw(std::int32_t{0}, a, b);
  if (!rvl) return bytes_of(head + mini_png::encode(format, mini_png::samples(image)));
  auto bytes = bytes_of(head + raw(image.width(), image.height()));
  const auto packed = RvlPacker::pack(std::span(image.data(), image.size()));
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  return bytes;
}

}  // namespace penumbra::test
