// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/intrinsics.hpp>

namespace penumbra::io {

/// Returns what is wrong with the size of an image in a message, or nothing.
[[nodiscard]] inline std::optional<std::string> check_image_size(std::uint64_t width,
                                                                 std::uint64_t height) {
  constexpr auto most = static_cast<std::uint64_t>(Intrinsics::max_size);
  constexpr auto most_pixels = static_cast<std::uint64_t>(Intrinsics::max_pixels);
  if (width >= 1 && height >= 1 && width <= most && height <= most && width * height <= most_pixels)
    return std::nullopt;
  return "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; 1 to " +
         std::to_string(most) + " each and " + std::to_string(most_pixels) + " in all are possible";
}

/// Reuses the buffer if the size stays the same.
template <typename T>
void resize_image(Image<T>& image, int width, int height) {
  if (image.width() != width || image.height() != height) image = Image<T>(width, height);
}

}  // namespace penumbra::io
