// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <penumbra/labels/labels.hpp>

namespace penumbra::test {

/// LabelRule without its fringe as plain loops over whole images, in its own words.
template <typename T>
class LabelReference {
 public:
  LabelReference(const LabelRule& rule, ImageView<const float> robot, ImageView<const T> measured)
      : rule_(rule),
        robot_(robot),
        measured_(measured),
        width_(robot.width),
        height_(robot.height) {
    labels_ = map([&](int u, int v) { return label_of(u, v); });
    if (rule_.front_min_width > 0) clean_up();
  }

  [[nodiscard]] const Image<Label>& labels() const { return labels_; }

 private:
  template <typename F>
  auto map(F&& f) const {
    Image<decltype(f(0, 0))> image(width_, height_);
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u) image(u, v) = f(u, v);
    return image;
  }

  [[nodiscard]] bool is_inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < width_ && v < height_;
  }
  [[nodiscard]] float tolerance(float z) const {
    const auto a = static_cast<float>(rule_.tolerance.a);
    const auto b = static_cast<float>(rule_.tolerance.b);
    const auto c = static_cast<float>(rule_.tolerance.c);
    return a + (b + c * z) * z;
  }
  [[nodiscard]] bool is_measured(int u, int v) const {
    float d = metres_of(measured_(u, v));
    if (d == 0.0f) return false;
    if constexpr (!std::is_same_v<T, float>) d = static_cast<float>(measured_(u, v) / 1000.0);
    return static_cast<float>(rule_.range.near) <= d && d <= static_cast<float>(rule_.range.far);
  }

  [[nodiscard]] Label label_of(int u, int v) const {
    const float z = robot_(u, v);
    if (!(z > 0.0f)) return Label::clear;
    if (!is_measured(u, v)) return Label::unknown;
    const float d = metres_of(measured_(u, v));
    const float e = tolerance(z);
    if (d < z - e) return Label::front;
    const bool is_past = d > z + static_cast<float>(rule_.beyond_factor) * e;
    return is_past && !rule_.fold_beyond ? Label::beyond : Label::occluded;
  }

  /// The nearest virtual depth of each cell, infinite without robot.
  [[nodiscard]] Image<float> nearest_of_cells() const {
    Image<float> cells(width_ / LabelRule::cell + 1, height_ / LabelRule::cell + 1,
                       std::numeric_limits<float>::infinity());
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u) {
        float& cell = cells(u / LabelRule::cell, v / LabelRule::cell);
        if (robot_(u, v) > 0.0f) cell = std::min(cell, robot_(u, v));
      }
    return cells;
  }

  [[nodiscard]] bool is_certain(const Image<float>& cells, int u, int v) const {
    if (!is_measured(u, v)) return false;
    if (rule_.edge_margin == 0) return labels_(u, v) == Label::front;
    const int reach = (rule_.edge_margin + LabelRule::cell - 1) / LabelRule::cell;
    const int i0 = u / LabelRule::cell, j0 = v / LabelRule::cell;
    float nearest = std::numeric_limits<float>::infinity();
    for (int j = std::max(0, j0 - reach); j <= std::min(cells.height() - 1, j0 + reach); ++j)
      for (int i = std::max(0, i0 - reach); i <= std::min(cells.width() - 1, i0 + reach); ++i)
        nearest = std::min(nearest, cells(i, j));
    return std::isfinite(nearest) && metres_of(measured_(u, v)) < nearest - tolerance(nearest);
  }

  /// Whether a certain pixel lies in a direction, at most front_min_width pixels away.
  [[nodiscard]] bool has_certain(const Image<char>& certain, int u, int v, int du, int dv) const {
    for (int i = 1; i <= rule_.front_min_width; ++i)
      if (is_inside(u + i * du, v + i * dv) && certain(u + i * du, v + i * dv) != 0) return true;
    return false;
  }

  [[nodiscard]] bool all_of_square(const Image<char>& image, int u, int v) const {
    for (int y = v; y < v + rule_.front_min_width; ++y)
      for (int x = u; x < u + rule_.front_min_width; ++x)
        if (!is_inside(x, y) || image(x, y) == 0) return false;
    return true;
  }

  void clean_up() {
    const Image<float> cells = nearest_of_cells();
    const Image<char> certain = map([&](int u, int v) -> char { return is_certain(cells, u, v); });
    const Image<char> counts = map([&](int u, int v) -> char {
      const auto has = [&](int du, int dv) { return has_certain(certain, u, v, du, dv); };
      return certain(u, v) != 0 ||
             (!is_measured(u, v) && ((has(-1, 0) && has(1, 0)) || (has(0, -1) && has(0, 1))));
    });
    Image<char> seeds(width_, height_);
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u) {
        if (!all_of_square(counts, u, v)) continue;
        for (int y = v; y < v + rule_.front_min_width; ++y)
          for (int x = u; x < u + rule_.front_min_width; ++x)
            seeds(x, y) |= labels_(x, y) == Label::front && certain(x, y) != 0;
      }
    const int reach = rule_.edge_margin / 2;
    labels_ = map([&](int u, int v) {
      if (labels_(u, v) != Label::front) return labels_(u, v);
      for (int y = std::max(0, v - reach); y <= std::min(height_ - 1, v + reach); ++y)
        for (int x = std::max(0, u - reach); x <= std::min(width_ - 1, u + reach); ++x)
          if (seeds(x, y) != 0) return Label::front;
      return Label::occluded;
    });
  }

  LabelRule rule_;
  ImageView<const float> robot_;
  ImageView<const T> measured_;
  int width_;
  int height_;
  Image<Label> labels_;
};

}  // namespace penumbra::test
