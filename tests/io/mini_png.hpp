// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <zlib.h>

#include <penumbra/base/image.hpp>

// PNG written and read straight from the specification (https://www.w3.org/TR/png-3), so that
// libpng is not its own judge.
namespace penumbra::test::mini_png {

struct Format {
  std::uint32_t width = 0, height = 0;
  int bits = 8;
  int color_type = 0;  // 0 grey, 2 RGB, 3 palette, 4 grey with alpha, 6 RGB with alpha
  bool interlaced = false;
};

inline int channels(int color_type) {
  constexpr std::array<int, 7> count = {1, 0, 3, 1, 2, 0, 4};
  return count.at(static_cast<std::size_t>(color_type));
}

inline std::string big_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>((value >> shift) & 0xff);
  return text;
}

inline std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

inline std::uint32_t crc(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

inline std::string chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data +
         big_endian(crc(type + data));
}

inline std::string signature() { return "\x89PNG\r\n\x1a\n"; }

inline std::string header(const Format& f) {
  return chunk("IHDR", big_endian(f.width) + big_endian(f.height) + static_cast<char>(f.bits) +
                           static_cast<char>(f.color_type) + std::string(2, '\0') +
                           static_cast<char>(f.interlaced ? 1 : 0));
}

inline std::string deflated(const std::string& raw) {
  uLongf size = ::compressBound(raw.size());
  std::string packed(size, '\0');
  ::compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(raw.data()), raw.size());
  packed.resize(size);
  return packed;
}

/// Big-endian samples of 16 bits, as they lie in a file.
inline std::string samples(const Image<std::uint16_t>& image) {
  std::string bytes;
  for (std::size_t i = 0; i < image.size(); ++i) {
    bytes += static_cast<char>(image.data()[i] >> 8);
    bytes += static_cast<char>(image.data()[i] & 0xff);
  }
  return bytes;
}

/// A file of unfiltered rows; `samples` are rows from above without filter bytes, 8 or 16 bits
/// each. `before_data`: further chunks.
inline std::string encode(const Format& f, const std::string& samples,
                          const std::string& before_data = {}) {
  const std::size_t pixel =
      static_cast<std::size_t>(channels(f.color_type)) * static_cast<std::size_t>(f.bits) / 8;
  std::string raw;
  const auto add_pass = [&](std::uint32_t u0, std::uint32_t v0, std::uint32_t du,
                            std::uint32_t dv) {
    if (u0 >= f.width) return;
    for (std::uint32_t v = v0; v < f.height; v += dv) {
      raw += '\0';
      for (std::uint32_t u = u0; u < f.width; u += du)
        raw += samples.substr((std::size_t{v} * f.width + u) * pixel, pixel);
    }
  };
  if (f.interlaced) {
    constexpr std::array<std::array<std::uint32_t, 4>, 7> adam7 = {{{0, 0, 8, 8},
                                                                    {4, 0, 8, 8},
                                                                    {0, 4, 4, 8},
                                                                    {2, 0, 4, 4},
                                                                    {0, 2, 2, 4},
                                                                    {1, 0, 2, 2},
                                                                    {0, 1, 1, 2}}};
    for (const auto& [u0, v0, du, dv] : adam7) add_pass(u0, v0, du, dv);
  } else {
    add_pass(0, 0, 1, 1);
  }
  return signature() + header(f) + before_data + chunk("IDAT", deflated(raw)) + chunk("IEND", "");
}

/// Undoes the five filters (section 9 of the specification) of rows that are not interlaced.
inline std::string unfiltered(const std::string& raw, std::size_t row_bytes, std::size_t pixel) {
  const std::size_t rows = raw.size() / (row_bytes + 1);
  std::string out(rows * row_bytes, '\0');
  for (std::size_t v = 0; v < rows; ++v) {
    const int filter = static_cast<unsigned char>(raw[v * (row_bytes + 1)]);
    for (std::size_t i = 0; i < row_bytes; ++i) {
      const auto at = [&](std::size_t back_rows, std::size_t back) -> int {
        if (v < back_rows || i < back) return 0;
        return static_cast<unsigned char>(out[(v - back_rows) * row_bytes + i - back]);
      };
      const int a = at(0, pixel), b = at(1, 0), c = at(1, pixel);
      const int p = a + b - c;
      const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
      const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      const std::array<int, 5> predicted = {0, a, b, (a + b) / 2, paeth};
      out[v * row_bytes + i] = static_cast<char>(raw[v * (row_bytes + 1) + 1 + i] +
                                                 predicted.at(static_cast<std::size_t>(filter)));
    }
  }
  return out;
}

}  // namespace penumbra::test::mini_png
