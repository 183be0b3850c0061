// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include <penumbra/planning/clearance-inl.hpp>

namespace penumbra::planning {

/// Measures it in a narrow window first.
double Clearance::measure(const SeenTarget& target, const VirtualDepthView& drawn, bool is_hidden,
                          int most) {
  constexpr int narrow = 16;  // pixels
  for (int within = std::min(narrow, most);; within = most) {
    const PixelRectangle window = overlap(grown(target.region, within, within),
                                          {0, 0, drawn.depth.width, drawn.depth.height});
    mark_blocked(target, drawn, window);
    const double found =
        is_hidden ? -hidden_depth(target, window, within) : free_distance(target, window, within);
    if (std::abs(found) < within || within == most) return found;
  }
}

/// Marks the pixels of the robot that are before the target; outside of the target's region, before
/// its middle.
void Clearance::mark_blocked(const SeenTarget& target, const VirtualDepthView& drawn,
                             const PixelRectangle& window) {
  blocked_.assign(
      static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()), 0);
  drawn.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    const PixelRectangle part = overlap({u0, v0, u1, v1}, window);
    for (int v = part.v0; v < part.v1; ++v) {
      const float* const depth = drawn.depth.row(v) + part.u0;
      std::uint8_t* const row = &blocked_[index(window, part.u0, v)];
      const int width = part.width();
      for (int u = 0; u < width; ++u)  // without branches, to vectorise
        row[u] = static_cast<std::uint8_t>((depth[u] > 0.0F) & (depth[u] < target.before));
    }
  });
  if (target.depth.empty()) return;
  const LimitRule rule(rule_, target.expected.margin);
  for (const RowSpan& span : target.spans)
    for_each_part(drawn.touched, span, [&](int u0, int u1, bool touched) {
      const float* const depth = drawn.depth.row(span.v) + u0;
      const float* const of = &target.depth(u0 - target.region.u0, span.v - target.region.v0);
      std::uint8_t* const row = &blocked_[index(window, u0, span.v)];
      for (int u = 0; touched && u < u1 - u0; ++u)
        row[u] = static_cast<std::uint8_t>((depth[u] > 0.0F) & (depth[u] < rule.at(of[u]).near));
    });
}

/// Returns the distance from the target's region to the nearest blocked pixel, `most` at most; 0
/// where they touch.
double Clearance::free_distance(const SeenTarget& target, const PixelRectangle& window,
                                int most) const {
  int best = (most + 1) * (most + 1);  // squared
  for (int v = window.v0; v < window.v1; ++v) {
    const std::uint8_t* const row = &blocked_[index(window, window.u0, v)];
    const auto find = [&](int u, int value) {
      const void* const found =
          std::memchr(row + u, value, static_cast<std::size_t>(window.width() - u));
      return found == nullptr ? window.width()
                              : static_cast<int>(static_cast<const std::uint8_t*>(found) - row);
    };
    for (int first = find(0, 1); first < window.width();) {
      const int end = find(first, 0);
      for (const RowSpan& span : target.spans) {
        const int dv = span.v - v;
        if (dv * dv >= best) continue;
        const int du =
            std::max({0, window.u0 + first - (span.u1 - 1), span.u0 - (window.u0 + end - 1)});
        best = std::min(best, du * du + dv * dv);
      }
      first = find(end, 1);
    }
  }
  return std::min(std::sqrt(best) - 1.0, static_cast<double>(most));
}

/// Returns how far the innermost blocked pixel of the target's region is from one that is free,
/// `most` at most: the exact distance transform, columns first (Felzenszwalb and Huttenlocher,
/// "Distance transforms of sampled functions"), in the rows where it can still grow. Its loops
/// vectorise.
double Clearance::hidden_depth(const SeenTarget& target, const PixelRectangle& window, int most) {
  using Pixels = std::int16_t;  // also squared: max_clearance
  const auto width = static_cast<std::size_t>(window.width());
  const auto cap = static_cast<Pixels>(most);
  columns_.resize(blocked_.size());
  for (std::size_t i = 0; i < width; ++i) columns_[i] = static_cast<Pixels>(cap * blocked_[i]);
  for (std::size_t i = width; i < columns_.size(); ++i) {
    const auto next = static_cast<Pixels>(columns_[i - width] + 1);
    columns_[i] = static_cast<Pixels>(std::min(cap, next) * blocked_[i]);
  }
  for (std::size_t row = columns_.size() - width; row > 0;) {
    row -= width;
    for (std::size_t i = row; i < row + width; ++i)
      columns_[i] = std::min(columns_[i], static_cast<Pixels>(columns_[i + width] + 1));
  }
  int deepest = 0;  // squared
  const auto most_of = [](std::span<const Pixels> row) { return int{std::ranges::max(row)}; };
  for (const RowSpan& span : target.spans) {
    const Pixels* const columns = &columns_[index(window, span.u0, span.v)];
    const auto pixels = static_cast<std::size_t>(span.u1 - span.u0);
    nearest_.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
      nearest_[i] = static_cast<Pixels>(columns[i] * columns[i]);
    int row = most_of(nearest_);
    if (row <= deepest) continue;
    // The squares of all columns that matter, beyond the image the largest.
    const int left = std::min(most, span.u0 - window.u0),
              right = std::min(most, window.u1 - span.u1);
    squares_.assign(pixels + 2 * static_cast<std::size_t>(most), static_cast<Pixels>(cap * cap));
    Pixels* const squares = &squares_[static_cast<std::size_t>(most)];
    for (int i = -left; i < static_cast<int>(pixels) + right; ++i)
      squares[i] = static_cast<Pixels>(columns[i] * columns[i]);
    for (int du = 1; du < most && row > std::max(deepest, du * du); ++du) {
      const auto square = static_cast<Pixels>(du * du);
      const Pixels *const left_of = squares - du, *const right_of = squares + du;
      Pixels* const nearest = nearest_.data();
      for (std::size_t i = 0; i < pixels; ++i) {
        const auto next = static_cast<Pixels>(square + std::min(left_of[i], right_of[i]));
        nearest[i] = std::min(nearest[i], next);
      }
      if (du % 4 == 0) row = most_of(nearest_);
    }
    deepest = std::max(deepest, most_of(nearest_));
  }
  return std::sqrt(deepest);
}

}  // namespace penumbra::planning
