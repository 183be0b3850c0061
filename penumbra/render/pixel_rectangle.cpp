// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

PixelRectangle PixelRectangle::united(const PixelRectangle& other) const {
  if (empty()) return other;
  if (other.empty()) return *this;
  return {std::min(u0, other.u0), std::min(v0, other.v0), std::max(u1, other.u1),
          std::max(v1, other.v1)};
}

PixelRectangle overlap(const PixelRectangle& a, const PixelRectangle& b) {
  const PixelRectangle both{std::max(a.u0, b.u0), std::max(a.v0, b.v0), std::min(a.u1, b.u1),
                            std::min(a.v1, b.v1)};
  return both.empty() ? PixelRectangle{} : both;
}

PixelRectangle pixels_of(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& T_camera_box,
                         const Intrinsics& k) {
  // Single-precision depths may lie this share on the other side of the near plane.
  constexpr double rounding = 1e-4;
  Eigen::AlignedBox2d pixels;
  int before = 0;
  for (int i = 0; i < 8; ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    const Eigen::Vector3d p = T_camera_box * box.corner(corner);
    if (p.z() < DepthRenderer::near_plane * (1.0 - rounding)) continue;
    ++before;
    pixels.extend(k.project(p));
  }
  if (before == 0) return {};
  if (before < 8) return {0, 0, k.width(), k.height()};
  // One pixel to spare: OpenGL rounds the corners of triangles to its grid.
  const auto first = [](double x, int size) {
    return static_cast<int>(std::clamp(std::ceil(x) - 1.0, 0.0, static_cast<double>(size)));
  };
  const auto last = [](double x, int size) {
    return static_cast<int>(std::clamp(std::floor(x) + 2.0, 0.0, static_cast<double>(size)));
  };
  const PixelRectangle seen{first(pixels.min().x(), k.width()), first(pixels.min().y(), k.height()),
                            last(pixels.max().x(), k.width()), last(pixels.max().y(), k.height())};
  return seen.empty() ? PixelRectangle{} : seen;
}

}  // namespace penumbra
