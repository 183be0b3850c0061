// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files.hpp"
#include "mini_png.hpp"

#include <span>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

inline std::vector<std::byte> bytes_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

/// Surfaces with noise and holes.
inline Image<std::uint16_t> depth_image(int width, int height, std::mt19937_64& random) {
  Image<std::uint16_t> image(width, height);
  for (const auto [u, v] : each_pixel(image))
    image(u, v) = (u / 5 + v / 3) % 4 == 0
                      ? std::uint16_t{0}
                      : static_cast<std::uint16_t>(700 + 30 * (u / 7) + random() % 9);
  return image;
}

/// RVL written from its paper: nibbles first, words of them at the end.
inline std::vector<std::byte> rvl_of(std::span<const std::uint16_t> depths) {
  std::vector<std::size_t> nibbles;
  const auto add = [&](std::size_t number) {
    for (; number >= 8; number /= 8) nibbles.push_back(8 + number % 8);
    nibbles.push_back(number);
  };
  int previous = 0;
  for (std::size_t at = 0; at < depths.size();) {
    std::size_t first = at;
    while (first < depths.size() && depths[first] == 0) ++first;
    std::size_t end = first;
    while (end < depths.size() && depths[end] != 0) ++end;
    add(first - at);
    add(end - first);
    for (at = first; at < end; previous = depths[at++]) {
      const int difference = depths[at] - previous;
      add(static_cast<std::size_t>(difference < 0 ? -2 * difference - 1 : 2 * difference));
    }
  }
  while (nibbles.size() % 8 != 0) nibbles.push_back(0);
  std::vector<std::byte> bytes;
  for (std::size_t word = 0; word < nibbles.size(); word += 8)
    for (std::size_t i = word + 8; i > word; i -= 2)  // the last nibbles lie in the first byte
      bytes.push_back(static_cast<std::byte>(16 * nibbles[i - 2] + nibbles[i - 1]));
  return bytes;
}

/// Data of the transport compressedDepth: parameters, then PNG or, with its size, RVL.
inline std::vector<std::byte> compressed_depth(const Image<std::uint16_t>& image, bool rvl, float a,
                                               float b) {
  const mini_png::Format format{static_cast<std::uint32_t>(image.width()),
                                static_cast<std::uint32_t>(image.height()), 16, 0, false};
  const std::string head = raw(std::int32_t{0}, a, b);
  if (!rvl) return bytes_of(head + mini_png::encode(format, mini_png::samples(image)));
  auto bytes = bytes_of(head + raw(image.width(), image.height()));
  const auto packed = rvl_of(std::span(image.data(), image.size()));
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  return bytes;
}

}  // namespace penumbra::test
