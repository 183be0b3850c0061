// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include <penumbra/camera/intrinsics.hpp>

namespace penumbra {

/// The pixels u0 <= u < u1, v0 <= v < v1 of an image.
struct PixelRectangle {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  [[nodiscard]] bool empty() const { return u0 >= u1 || v0 >= v1; }
  [[nodiscard]] int width() const { return u1 - u0; }
  [[nodiscard]] int height() const { return v1 - v0; }

  /// The smallest rectangle that holds both.
  [[nodiscard]] PixelRectangle united(const PixelRectangle& other) const;
};

/// The pixels of both; empty where there are none.
[[nodiscard]] PixelRectangle overlap(const PixelRectangle& a, const PixelRectangle& b);

/// Calls f with rectangles that make up what of `old` is not in `kept`.
template <typename F>
void for_each_outside(const PixelRectangle& old, const PixelRectangle& kept, F&& f) {
  const PixelRectangle both = overlap(old, kept);
  const auto call = [&](const PixelRectangle& r) {
    if (!r.empty()) f(r);
  };
  if (both.empty()) return call(old);
  call({old.u0, old.v0, old.u1, both.v0});
  call({old.u0, both.v1, old.u1, old.v1});
  call({old.u0, both.v0, both.u0, both.v1});
  call({both.u1, both.v0, old.u1, both.v1});
}

/// Pixels in which a box's contents before the near plane may be seen: none left out, the whole
/// image where the box reaches through the near plane.
[[nodiscard]] PixelRectangle pixels_of(const Eigen::AlignedBox3d& box,
                                       const Eigen::Isometry3d& T_camera_box,
                                       const Intrinsics& intrinsics);

}  // namespace penumbra
