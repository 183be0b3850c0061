// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <penumbra/base/image.hpp>

#include <io/files/image_size.hpp>

namespace penumbra::io {

/// Returns what is wrong with an image of a valid size in a file of so many bytes: that they cannot
/// hold it in any compression, so that no memory is taken for it. Nothing else is as dense as
/// Zstandard, of which four bytes can be 128 KiB.
[[nodiscard]] inline std::optional<std::string> check_expansion(ImageSize size,
                                                                std::uint64_t file_bytes) {
  constexpr std::uint64_t most_pixels_of_byte = 1U << 14U;
  const auto pixels =
      static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
  if (pixels / most_pixels_of_byte <= file_bytes) return std::nullopt;
  return "has " + std::to_string(size.width) + " x " + std::to_string(size.height) +
         " pixels, more than a file of " + std::to_string(file_bytes) + " bytes can hold";
}

/// Returns the depth image of a file's pixels. `scale`: metres per unit; default: millimetres for
/// integers, metres for floating-point numbers.
template <typename T>
[[nodiscard]] SharedDepth shared_depth_of(Image<T> pixels, std::optional<double> scale) {
  constexpr bool is_plain = std::is_same_v<T, std::uint16_t> || std::is_same_v<T, float>;
  if constexpr (is_plain)
    if (!scale) return SharedDepth(std::make_shared<const Image<T>>(std::move(pixels)));
  const double unit = scale.value_or(std::integral<T> ? 0.001 : 1.0);
  Image<float> metres(pixels.width(), pixels.height());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const T value = pixels.data()[i];
    bool is_measured = value > T{0};
    if constexpr (is_plain) is_measured = metres_of(value) > 0.0F;
    if (is_measured) metres.data()[i] = static_cast<float>(unit * static_cast<double>(value));
  }
  return SharedDepth(std::make_shared<const Image<float>>(std::move(metres)));
}

}  // namespace penumbra::io
