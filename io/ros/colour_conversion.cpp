// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <io/ros/colour_conversion-inl.hpp>

namespace penumbra::io {
namespace {

std::uint8_t octet_of(std::byte byte) { return std::to_integer<std::uint8_t>(byte); }

template <std::size_t r, std::size_t g, std::size_t b, std::size_t bytes>
void convert_plain(const std::byte* from, Rgb8* to, std::size_t pixels) {
  for (std::size_t i = 0; i < pixels; ++i, from += bytes)
    to[i] = {octet_of(from[r]), octet_of(from[g]), octet_of(from[b])};
}

void copy_rgb(const std::byte* from, Rgb8* to, std::size_t pixels) {
  std::memcpy(to, from, 3 * pixels);
}

// What the colour of two pixels adds to their grey, in 1/256.
struct Chroma {
  int r, g, b;
};

// ITU-R BT.601, narrow range: y of 16 to 235, u and v of 16 to 240.
Chroma chroma_of(std::byte u_octet, std::byte v_octet) {
  const int u = octet_of(u_octet) - 128, v = octet_of(v_octet) - 128;
  return {409 * v, -100 * u - 208 * v, 516 * u};
}

// Clamped to 0..255 by a table: values of rgb_of lie in -277 to 534.
constexpr int least_value = -300;
constexpr auto clamped_values = [] {
  std::array<std::uint8_t, 900> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<std::uint8_t>(std::clamp(static_cast<int>(i) + least_value, 0, 255));
  return values;
}();

std::uint8_t clamped_octet(int value) {
  return clamped_values[static_cast<std::size_t>((value >> 8) - least_value)];
}

Rgb8 rgb_of(std::byte y, const Chroma& chroma) {
  const int grey = 298 * (octet_of(y) - 16) + 128;
  return {clamped_octet(grey + chroma.r), clamped_octet(grey + chroma.g),
          clamped_octet(grey + chroma.b)};
}

// Where y of the first pixel, u, y of the second and v stand in four bytes.
template <std::size_t y0, std::size_t u, std::size_t y1, std::size_t v>
void convert_pairs(const std::byte* from, Rgb8* to, std::size_t pixels) {
  for (std::size_t i = 0; i + 1 < pixels; i += 2, from += 4) {
    const Chroma chroma = chroma_of(from[u], from[v]);
    to[i] = rgb_of(from[y0], chroma);
    to[i + 1] = rgb_of(from[y1], chroma);
  }
}

constexpr std::array<ColourFormat, 7> colour_formats = {
    {{"rgb8", 3, false, copy_rgb},
     {"bgr8", 3, false, convert_plain<2, 1, 0, 3>},
     {"rgba8", 4, false, convert_plain<0, 1, 2, 4>},
     {"bgra8", 4, false, convert_plain<2, 1, 0, 4>},
     {"mono8", 1, false, convert_plain<0, 0, 0, 1>},
     {"yuv422", 2, true, convert_pairs<1, 0, 3, 2>},
     {"yuv422_yuy2", 2, true, convert_pairs<0, 1, 2, 3>}}};

}  // namespace

const ColourFormat* find_colour_format(std::string_view encoding) {
  const auto* at = std::find_if(colour_formats.begin(), colour_formats.end(),
                                [&](const auto& format) { return format.encoding == encoding; });
  return at == colour_formats.end() ? nullptr : at;
}

}  // namespace penumbra::io
