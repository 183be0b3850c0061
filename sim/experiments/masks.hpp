// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include <penumbra/base/image.hpp>
#include <penumbra/occlusion/target.hpp>

namespace penumbra::sim {

/// Pixels that a filter takes away beside those it names: depth is blurred at edges.
inline constexpr int filter_margin = 3;

/// A copy of `mask` without the pixels of its box for which `removed(u, v)` holds, nor those up to
/// filter_margin pixels beside them.
template <typename Removed>
[[nodiscard]] Image<std::uint8_t> without(const Image<std::uint8_t>& mask, const PixelBox& box,
                                          Removed removed) {
  Image<std::uint8_t> rest = mask;
  const int u0 = static_cast<int>(box.u), u1 = static_cast<int>(box.u + box.width);
  const int v0 = static_cast<int>(box.v), v1 = static_cast<int>(box.v + box.height);
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) {
      if (mask(u, v) == 0 || !removed(u, v)) continue;
      for (int y = std::max(v - filter_margin, v0); y <= std::min(v + filter_margin, v1 - 1); ++y)
        for (int x = std::max(u - filter_margin, u0); x <= std::min(u + filter_margin, u1 - 1); ++x)
          rest(x, y) = 0;
    }
  return rest;
}

}  // namespace penumbra::sim
