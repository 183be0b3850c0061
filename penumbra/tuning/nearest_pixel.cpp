// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <penumbra/tuning/nearest_pixel-inl.hpp>

namespace penumbra::tuning {
namespace {

int squared(int u, int v, NearestPixels::Pixel to) {
  return (to.u - u) * (to.u - u) + (to.v - v) * (to.v - v);
}

}  // namespace

void NearestPixels::sweep() {
  const int width = nearest_.width(), height = nearest_.height();
  const auto sweep_row = [&](int v, int from_v) {
    for (int u = 0; u < width; ++u)
      for (int du = -1; du <= 1; ++du) take(u, v, u + du, from_v);
    for (int u = 1; u < width; ++u) take(u, v, u - 1, v);
    for (int u = width - 2; u >= 0; --u) take(u, v, u + 1, v);
  };
  for (int v = 0; v < height; ++v) sweep_row(v, v - 1);
  for (int v = height - 1; v >= 0; --v) sweep_row(v, v + 1);
}

double NearestPixels::distance(int u, int v) const {
  const Pixel nearest = nearest_(u, v);
  return nearest.u < 0 ? std::numeric_limits<double>::infinity()
                       : std::sqrt(static_cast<double>(squared(u, v, nearest)));
}

void NearestPixels::take(int u, int v, int from_u, int from_v) {
  if (from_u < 0 || from_v < 0 || from_u >= nearest_.width() || from_v >= nearest_.height()) return;
  const Pixel candidate = nearest_(from_u, from_v);
  Pixel& own = nearest_(u, v);
  if (candidate.u >= 0 && (own.u < 0 || squared(u, v, candidate) < squared(u, v, own)))
    own = candidate;
}

}  // namespace penumbra::tuning
