// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
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

  /// Gives the image a size. Its pixels are T{} if it had another size, else unchanged.
  void fit(int width, int height) {
    if (width != width_ || height != height_) *this = Image(width, height);
  }

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

inline constexpr float metres_per_millimetre = 0.001F;

/// The depths of a sensor that are measurements. Comparisons have no branches, so that loops
/// vectorise.
struct MeasuredRange {
  constexpr MeasuredRange() = default;
  /// Metres; near >= 0.
  MeasuredRange(double from, double to) {
    constexpr double rounding = 0.01;  // millimetres
    near = std::max(near, static_cast<float>(from));
    far = std::min(far, static_cast<float>(to));
    first = static_cast<std::uint16_t>(
        std::ceil(std::clamp(1000.0 * from - rounding, 1.0, 1.0 * saturated_depth)));
    last = static_cast<std::uint16_t>(std::clamp(1000.0 * to + rounding, 0.0, 1.0 * last));
  }

  [[nodiscard]] bool holds(float metres) const { return (near <= metres) & (metres <= far); }
  [[nodiscard]] bool holds(std::uint16_t millimetres) const {
    return (first <= millimetres) & (millimetres <= last);
  }

  float near = std::numeric_limits<float>::min(), far = std::numeric_limits<float>::max();
  std::uint16_t first = 1, last = saturated_depth - 1;  ///< none if last < first
};

/// Returns a sensor's depth in metres; 0: no measurement.
[[nodiscard]] inline float metres_of(std::uint16_t depth, const MeasuredRange& range = {}) {
  return range.holds(depth) ? metres_per_millimetre * static_cast<float>(depth) : 0.0F;
}
[[nodiscard]] inline float metres_of(float depth, const MeasuredRange& range = {}) {
  return range.holds(depth) ? depth : 0.0F;
}
[[nodiscard]] inline Image<float> metres_of(const DepthView& view,
                                            const MeasuredRange& range = {}) {
  return std::visit(
      [&](const auto& depth) {
        Image<float> metres(depth.width, depth.height);
        for (int v = 0; v < depth.height; ++v)
          for (int u = 0; u < depth.width; ++u) metres(u, v) = metres_of(depth(u, v), range);
        return metres;
      },
      view);
}

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// A view of pixels that it may keep alive. Without an owner it refers to the caller's memory.
template <typename View>
struct Shared {
  View view = {};
  std::shared_ptr<const void> owner = {};

  Shared() = default;
  template <typename V>
  requires std::convertible_to<const V&, View> Shared(
      const V& pixels,  // NOLINT(google-explicit-constructor)
      std::shared_ptr<const void> kept_by = {})
      : view(pixels), owner(std::move(kept_by)) {}
  template <typename T>
  requires std::convertible_to<ImageView<const T>, View>
  explicit Shared(std::shared_ptr<const Image<T>> image) : view(image->view()), owner(image) {}
};
using SharedDepth = Shared<DepthView>;
using SharedColor = Shared<ImageView<const Rgb8>>;

/// Returns whether there is no depth image.
[[nodiscard]] inline bool is_empty(const DepthView& depth) {
  return std::visit([](const auto& view) { return view.empty(); }, depth);
}

/// The tiles of an image that are not empty, so that the cost of later stages depends on touched
/// pixels and not on the image's size. Bit i of rows[j] is the tile with the first pixel
/// (i * tile_width, j * tile_height); the last tile of a row or column may extend past the image.
struct TileMask {
  static constexpr int tile_height = 8;

  int width = 0;        ///< of the image, pixels
  int height = 0;       ///< of the image, pixels
  int tile_width = 32;  ///< pixels; a power of two so that at most 64 tiles span the image
  std::vector<std::uint64_t> rows;

  TileMask() = default;
  TileMask(int image_width, int image_height) : width(image_width), height(image_height) {
    while (tile_width * 64 < image_width) tile_width *= 2;
    rows.assign(static_cast<std::size_t>((image_height + tile_height - 1) / tile_height), 0);
  }

  /// Marks every tile with a pixel of [u0, u1] x [v0, v1], bounds inside the image.
  void mark(int u0, int v0, int u1, int v1) {
    const std::uint64_t upto = ~std::uint64_t{0} >> (63 - u1 / tile_width);
    const std::uint64_t bits = upto & (~std::uint64_t{0} << (u0 / tile_width));
    for (int j = v0 / tile_height; j <= v1 / tile_height; ++j)
      rows[static_cast<std::size_t>(j)] |= bits;
  }

  /// Returns whether the tile of a pixel is marked.
  [[nodiscard]] bool holds(int u, int v) const {
    return (rows[static_cast<std::size_t>(v / tile_height)] >> (u / tile_width) & 1U) != 0;
  }

  /// Calls f(u0, u1, v0, v1) for every run of marked tiles in a tile row: the pixels u0 <= u < u1,
  /// v0 <= v < v1, cut to the image.
  template <typename F>
  void for_each_span(F&& f) const {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const int v0 = static_cast<int>(j) * tile_height;
      const int v1 = v0 + tile_height < height ? v0 + tile_height : height;
      for (std::uint64_t bits = rows[j]; bits != 0;) {
        const int first = std::countr_zero(bits);
        const int count = std::countr_one(bits >> first);
        const int u1 = (first + count) * tile_width;
        f(first * tile_width, u1 < width ? u1 : width, v0, v1);
        bits = first + count >= 64 ? 0 : bits & (~std::uint64_t{0} << (first + count));
      }
    }
  }
};

/// A virtual depth image: what the camera would measure if there were only the robot.
struct VirtualDepthView {
  ImageView<const float> depth;          ///< metres along the optical axis; 0: no robot on the ray
  ImageView<const std::uint16_t> links;  ///< link index + 1 of the nearest surface; 0: none
  const TileMask* touched = nullptr;     ///< outside of these tiles depth and links are 0
};

}  // namespace penumbra
