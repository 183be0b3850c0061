// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/rectification.hpp>

namespace penumbra::io {

struct ImageSize {
  int width = 0;
  int height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// Returns the fault of an image whose size differs from the camera's.
[[nodiscard]] inline std::string wrong_size(ImageSize got, ImageSize wanted) {
  return "has " + std::to_string(got.width) + " x " + std::to_string(got.height) +
         " pixels; the camera has " + std::to_string(wanted.width) + " x " +
         std::to_string(wanted.height);
}

/// Returns what is wrong with the size that a file or message states, or nothing.
[[nodiscard]] inline std::optional<std::string> check_image_size(std::uint64_t width,
                                                                 std::uint64_t height) {
  constexpr auto most = static_cast<std::uint64_t>(Intrinsics::max_size);
  constexpr auto most_pixels = static_cast<std::uint64_t>(Intrinsics::max_pixels);
  if (width >= 1 && height >= 1 && width <= most && height <= most && width * height <= most_pixels)
    return std::nullopt;
  return "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; 1 to " +
         std::to_string(most) + " each and " + std::to_string(most_pixels) + " in all are possible";
}

/// Returns a copy without gaps between its rows.
template <typename T>
[[nodiscard]] Image<T> copy_of(ImageView<const T> from) {
  Image<T> image(from.width, from.height);
  for (int v = 0; v < from.height; ++v) std::copy_n(from.row(v), from.width, image.view().row(v));
  return image;
}

/// Returns an image in the geometry of the report's images: `raw` without a rectification, else
/// `image`, to which it is remapped.
template <typename T>
[[nodiscard]] ImageView<const T> rectified(const Rectification* rectification,
                                           ImageView<const T> raw, Image<T>& image) {
  if (rectification == nullptr || raw.empty()) return raw;
  const Intrinsics& pinhole = rectification->pinhole();
  if (image.empty()) image = Image<T>(pinhole.width(), pinhole.height());
  remap(rectification->pinhole_to_raw(), raw, T{}, image.view());
  return std::as_const(image).view();
}

}  // namespace penumbra::io
