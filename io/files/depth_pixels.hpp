// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <penumbra/base/image.hpp>

namespace penumbra::io {

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
