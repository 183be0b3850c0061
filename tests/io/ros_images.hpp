// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mini_png.hpp"
#include "ros_rvl.hpp"

#include <cstring>
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

inline std::vector<std::byte> png_of(const Image<std::uint16_t>& image) {
  std::string samples;
  for (std::size_t i = 0; i < image.size(); ++i) {
    samples += static_cast<char>(image.data()[i] >> 8);
    samples += static_cast<char>(image.data()[i] & 0xff);
  }
  const mini_png::Format format{static_cast<std::uint32_t>(image.width()),
                                static_cast<std::uint32_t>(image.height()), 16, 0, false};
  return bytes_of(mini_png::encode(format, samples));
}

template <typename T>
void append_number(std::vector<std::byte>& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

/// Data of the transport compressedDepth: parameters, then PNG or, with its size, RVL.
inline std::vector<std::byte> compressed_depth(const Image<std::uint16_t>& image, bool rvl, float a,
                                               float b) {
  std::vector<std::byte> bytes;
  append_number(bytes, std::int32_t{0});
  append_number(bytes, a);
  append_number(bytes, b);
  if (rvl) {
    append_number(bytes, image.width());
    append_number(bytes, image.height());
  }
  const auto packed = rvl ? RvlPacker::pack(std::span(image.data(), image.size())) : png_of(image);
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  return bytes;
}

}  // namespace penumbra::test
