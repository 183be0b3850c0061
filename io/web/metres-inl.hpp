// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/image.hpp>

namespace penumbra::io {

template <typename T>
void fill_metres(ImageView<const T> from, Image<float>& to) {
  if (to.width() != from.width || to.height() != from.height)
    to = Image<float>(from.width, from.height);
  for (int v = 0; v < from.height; ++v)
    for (int u = 0; u < from.width; ++u) to(u, v) = metres_of(from(u, v));
}

}  // namespace penumbra::io
