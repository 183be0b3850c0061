// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <penumbra/base/image.hpp>

namespace penumbra::io {

/// A sensor's depth; 0: no measurement.
inline float metres_of(std::uint16_t depth) {
  return depth == saturated_depth ? 0.0F : 0.001F * static_cast<float>(depth);
}
inline float metres_of(float depth) { return std::isfinite(depth) && depth > 0 ? depth : 0.0F; }

template <typename T>
void fill_metres(ImageView<const T> from, Image<float>& to) {
  if (to.width() != from.width || to.height() != from.height)
    to = Image<float>(from.width, from.height);
  for (int v = 0; v < from.height; ++v)
    for (int u = 0; u < from.width; ++u) to(u, v) = metres_of(from(u, v));
}

}  // namespace penumbra::io
