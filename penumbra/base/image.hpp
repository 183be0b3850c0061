// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <variant>
#include <vector>

namespace penumbra {

/// A view of a row-major image. Pixel (u, v) is in column u (to the right) and row v (down).
template <typename T>
struct ImageView {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< elements from one row to the next; negative for a flipped image

  [[nodiscard]] T* row(int v) const { return data + v * stride; }
  [[nodiscard]] T& operator()(int u, int v) const { return row(v)[u]; }
  [[nodiscard]] bool empty() const { return data == nullptr || width <= 0 || height <= 0; }

  operator ImageView<const T>() const  // NOLINT(google-explicit-constructor): as T* to const T*
      requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// An image that owns its pixels, without gaps between rows.
template <typename T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T value = T{})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] T* data() { return pixels_.data(); }
  [[nodiscard]] const T* data() const { return pixels_.data(); }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] T& operator()(int u, int v) { return view()(u, v); }
  [[nodiscard]] const T& operator()(int u, int v) const { return view()(u, v); }

  [[nodiscard]] ImageView<T> view() { return {pixels_.data(), width_, height_, width_}; }
  [[nodiscard]] ImageView<const T> view() const {
    return {pixels_.data(), width_, height_, width_};
  }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

/// The value in millimetres of a depth that does not fit.
inline constexpr std::uint16_t saturated_depth = 0xFFFF;

/// A sensor's depth image: millimetres as uint16 or metres as float32, z-depth along the optical
/// axis. 0, NaN, inf, negative values and saturated_depth are "no measurement".
using DepthView = std::variant<ImageView<const std::uint16_t>, ImageView<const float>>;

/// Returns a sensor's depth in metres; 0: no measurement.
[[nodiscard]] inline float metres_of(std::uint16_t depth) {
  return depth == saturated_depth ? 0.0F : 0.001F * static_cast<float>(depth);
}
[[nodiscard]] inline float metres_of(float depth) {
  return std::isfinite(depth) && depth > 0 ? depth : 0.0F;
}

}  // namespace penumbra
