// SPDX-License-Identifier: Apache-2.0
// The format: ISO/IEC 15948:2004, "Portable Network Graphics (PNG)".
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include <libdeflate.h>

#include <penumbra/camera/camera.hpp>

#include <io/files/png_depth.hpp>

namespace penumbra::io {
namespace {

using Byte = std::uint8_t;
using Bytes = std::span<const Byte>;

std::uint32_t big_endian(const Byte* p) {
  return std::uint32_t{p[0]} << 24U | std::uint32_t{p[1]} << 16U | std::uint32_t{p[2]} << 8U | p[3];
}

/// The size of an image, and its compressed pixels.
struct PngParts {
  int width = 0, height = 0;
  std::vector<Byte> pixels;
};

/// Returns false if there is anything but 16-bit grey without interlace in it.
bool split(Bytes file, PngParts& parts) {
  constexpr std::size_t signature = 8, around = 12;  // length, name and checksum
  constexpr std::string_view expected = "\x89PNG\r\n\x1a\n";
  if (file.size() < signature || std::memcmp(file.data(), expected.data(), signature) != 0)
    return false;
  for (Bytes rest = file.subspan(signature); rest.size() >= around;) {
    const std::size_t length = big_endian(rest.data());
    if (length > rest.size() - around) return false;
    const std::string_view name(reinterpret_cast<const char*>(rest.data()) + 4, 4);
    const Bytes data = rest.subspan(8, length);
    if (libdeflate_crc32(0, rest.data() + 4, 4 + length) != big_endian(data.data() + length))
      return false;
    if ((name == "IHDR") != (parts.width == 0)) return false;  // it is the first, and the only one
    if (name == "IEND") return true;
    if (name == "IHDR") {
      constexpr std::array<Byte, 5> grey16 = {16, 0, 0, 0, 0};
      const auto is_possible = [](std::uint32_t size) {
        return size > 0 && size <= std::uint32_t{Intrinsics::max_size};
      };
      if (length != 13 || !is_possible(big_endian(&data[0])) ||
          !is_possible(big_endian(&data[4])) || !std::ranges::equal(data.subspan(8), grey16))
        return false;
      parts.width = static_cast<int>(big_endian(&data[0]));
      parts.height = static_cast<int>(big_endian(&data[4]));
    } else if (name == "IDAT") {
      parts.pixels.insert(parts.pixels.end(), data.begin(), data.end());
    } else if (name == "tRNS" || name[0] < 'a') {
      return false;  // transparency, or what nobody may pass over
    }
    rest = rest.subspan(around + length);
  }
  return false;
}

/// The predictor of Paeth for values in vectors or alone: of left, above and above on the left.
template <typename V>
V paeth(V a, V b, V c) {
  const auto size_of = [](V v) { return v < 0 ? -v : v; };
  const V of_a = size_of(b - c), of_b = size_of(a - c), of_c = size_of(a + b - c - c);
  const V of_both = of_b <= of_c ? b : c;
  return ((of_a <= of_b) & (of_a <= of_c)) ? a : of_both;
}

constexpr std::ptrdiff_t pixel_bytes = 2;

/// Undoes the filter of one row. Returns false for an unknown one.
bool unfilter(Byte filter, const Byte* from, const Byte* above, Byte* to, std::ptrdiff_t count) {
  const auto left = [&](std::ptrdiff_t i) {
    return i < pixel_bytes ? 0 : int{to[i - pixel_bytes]};
  };
  const auto corner = [&](std::ptrdiff_t i) {
    return i < pixel_bytes ? 0 : int{above[i - pixel_bytes]};
  };
  const auto add = [&](const auto& predict) {
    for (std::ptrdiff_t i = 0; i < count; ++i) to[i] = static_cast<Byte>(from[i] + predict(i));
    return true;
  };
  switch (filter) {
    case 0:
      return add([](std::ptrdiff_t) { return 0; });
    case 1:
      return add(left);
    case 2:
      return add([&](std::ptrdiff_t i) { return int{above[i]}; });
    case 3:
      return add([&](std::ptrdiff_t i) { return (left(i) + above[i]) / 2; });
    case 4:
      return add([&](std::ptrdiff_t i) { return paeth<int>(left(i), above[i], corner(i)); });
    default:
      return false;
  }
}

constexpr int paeth_filter = 4;
constexpr int rows_at_once = 4;
using Lanes [[gnu::vector_size(16)]] = std::int16_t;
using LaneBytes [[gnu::vector_size(8)]] = Byte;

/// Undoes Paeth's filter in four rows, each a pixel behind the one above, since a pixel needs the
/// ones on its left and above. Rows begin `from_step` and `to_step` bytes after each other.
void unfilter_paeth(const Byte* from, std::ptrdiff_t from_step, const Byte* above, Byte* to,
                    std::ptrdiff_t to_step, std::ptrdiff_t width) {
  // Where a row's two bytes are in a word: a vector's first lanes are the first bytes in memory.
  const auto shift = [](int r) {
    return 16 * (std::endian::native == std::endian::little ? r : rows_at_once - 1 - r);
  };
  std::uint64_t word = 0;      // the last pixel of each row
  Lanes last{}, last_above{};  // the same in two lanes a row, and what was above those pixels
  const auto step = [&]<bool is_inside>(std::ptrdiff_t t) {
    const auto holds = [&](std::ptrdiff_t u) { return is_inside || (0 <= u && u < width); };
    // Whole words: to read back what was written in parts is slow.
    const auto word_of = [](const Byte* p) {
      std::uint16_t two;
      std::memcpy(&two, p, pixel_bytes);
      return std::uint64_t{two};
    };
    const auto lanes_of = [](std::uint64_t bytes) {
      return __builtin_convertvector(std::bit_cast<LaneBytes>(bytes), Lanes);
    };
    std::uint64_t above_them = std::endian::native == std::endian::little ? word << 16 : word >> 16;
    if (holds(t)) above_them |= word_of(above + t * pixel_bytes) << shift(0);
    const Lanes up = lanes_of(above_them);
    word = 0;
    for (int r = 0; r < rows_at_once; ++r)
      if (holds(t - r)) word |= word_of(from + r * from_step + (t - r) * pixel_bytes) << shift(r);
    last = (lanes_of(word) + paeth(last, up, last_above)) & 255;
    last_above = up;
    word = std::bit_cast<std::uint64_t>(__builtin_convertvector(last, LaneBytes));
    for (int r = 0; r < rows_at_once; ++r) {
      if (!holds(t - r)) continue;
      const auto two = static_cast<std::uint16_t>(word >> shift(r));
      std::memcpy(to + r * to_step + (t - r) * pixel_bytes, &two, pixel_bytes);
    }
  };
  const std::ptrdiff_t inside = std::min<std::ptrdiff_t>(rows_at_once - 1, width);
  std::ptrdiff_t t = 0;
  for (; t < inside; ++t) step.template operator()<false>(t);
  for (; t < width; ++t) step.template operator()<true>(t);
  for (; t < width + rows_at_once - 1; ++t) step.template operator()<false>(t);
}

}  // namespace

bool decode_depth_png(std::span<const std::byte> file, Image<std::uint16_t>& image,
                      std::optional<ImageSize> wanted) {
  PngParts parts;
  if (!split({reinterpret_cast<const Byte*>(file.data()), file.size()}, parts)) return false;
  if (wanted && (wanted->width != parts.width || wanted->height != parts.height)) return false;
  const std::ptrdiff_t count = pixel_bytes * parts.width, step = count + 1;
  const auto size = static_cast<std::size_t>(step * parts.height);
  constexpr std::size_t most_expansion = 1032;  // of deflate
  if (size / most_expansion > parts.pixels.size()) return false;
  const auto filtered = std::make_unique_for_overwrite<Byte[]>(size);
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!inflater ||
      libdeflate_zlib_decompress(inflater.get(), parts.pixels.data(), parts.pixels.size(),
                                 filtered.get(), size, nullptr) != LIBDEFLATE_SUCCESS)
    return false;
  image.fit(parts.width, parts.height);
  const std::vector<Byte> nothing(static_cast<std::size_t>(count));
  auto* const rows = reinterpret_cast<Byte*>(image.data());
  for (int v = 0; v < parts.height;) {
    const Byte* const from = filtered.get() + v * step;
    Byte* const to = rows + v * count;
    const Byte* const above = v == 0 ? nothing.data() : to - count;
    const auto is_paeth = [&](int row) { return from[row * step] == paeth_filter; };
    if (v + rows_at_once <= parts.height && is_paeth(0) && is_paeth(1) && is_paeth(2) &&
        is_paeth(3)) {
      unfilter_paeth(from + 1, step, above, to, count, parts.width);
      v += rows_at_once;
    } else {
      if (!unfilter(*from, from + 1, above, to, count)) return false;
      ++v;
    }
  }
  if constexpr (std::endian::native == std::endian::little)
    std::transform(
        image.data(), image.data() + count / pixel_bytes * parts.height, image.data(),
        [](std::uint16_t value) { return static_cast<std::uint16_t>(value << 8U | value >> 8U); });
  return true;
}

}  // namespace penumbra::io
