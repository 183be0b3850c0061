// SPDX-License-Identifier: Apache-2.0
// A rule as the kernels take it, and an image's measurements by it.
#pragma once

#include <cstdint>
#include <type_traits>

#include <penumbra/base/image.hpp>
#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace labelling {

/// A LabelRule for the kernels. All arithmetic is float32, without fused multiply-add.
struct Rule {
  explicit Rule(const LabelRule& rule);

  float a, b, c;
  float beyond_factor;  ///< infinite if beyond is folded
  MeasuredRange range;
  int width;  ///< front_min_width
  int cells;  ///< the edge margin, cells
  int reach;  ///< how far from a seed a pixel stays front

  [[nodiscard]] bool cleans_up() const { return width > 0; }
};

/// Set in what is known of a scene, millimetres, if it was seen only once: it confirms nothing.
inline constexpr std::uint16_t seen_once = 0x8000;

}  // namespace labelling

/// An image's measurements in metres; 0 where there is none.
template <typename T>
struct Measured {
  Measured(ImageView<const T> of, const labelling::Rule& rule) : image(of), range(rule.range) {}

  struct Row {
    [[nodiscard]] float operator[](int u) const { return metres_of(depth[u], range); }
    [[nodiscard]] bool is_measured(int u) const { return range.holds(depth[u]); }
    /// The value in metres, measured or not: loops that compare it vectorise.
    [[nodiscard]] float raw(int u) const {
      return std::is_same_v<T, float> ? depth[u] : metres_per_millimetre * depth[u];
    }

    const T* depth;
    MeasuredRange range;
  };
  [[nodiscard]] Row row(int v) const { return {image.row(v), range}; }

  ImageView<const T> image;
  MeasuredRange range;
};

}  // namespace penumbra
