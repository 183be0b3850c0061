// SPDX-License-Identifier: Apache-2.0
// What the stages of the CPU renderer hand to each other within a frame.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/image.hpp>
#include <penumbra/camera/camera.hpp>
#include <penumbra/render/clusters.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/triangle_groups.hpp>

namespace penumbra::cpu {

/// Storage for whole cache lines and vectors.
template <typename T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};
  AlignedAllocator() = default;
  template <typename U>
  AlignedAllocator(const AlignedAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), alignment)); }
  void deallocate(T* p, std::size_t /*n*/) { ::operator delete(p, alignment); }
  bool operator==(const AlignedAllocator& /*other*/) const { return true; }
};
template <typename T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

inline constexpr int block_width = 4;  // pixels; a block is one vector: 4 x (lanes / 4) pixels

/// A side of the view as a plane through the camera's centre: inside, s across + t z >= 0.
struct ViewSide {
  float s = 0.0F, t = 0.0F;
  ViewSide() = default;
  ViewSide(double sign, double tangent)
      : s(static_cast<float>(sign / std::hypot(1.0, tangent))),
        t(static_cast<float>(tangent / std::hypot(1.0, tangent))) {}
};

/// The camera as the kernel needs it. Beyond the guard band around the principal point triangles
/// are clipped, since pixel coordinates in float lose digits far away.
struct View {
  explicit View(const Intrinsics& k)
      : intrinsics(k),
        guard_u(2048.0 + std::abs(k.cx()) + k.width()),
        guard_v(2048.0 + std::abs(k.cy()) + k.height()) {
    look_at({0, 0, k.width(), k.height()});
  }

  /// Sets the sides of the window that matters.
  void look_at(const PixelRectangle& window) {
    const Intrinsics& k = intrinsics;
    left = {1.0, (k.cx() - window.u0 + 1.0) / k.fx()};
    right = {-1.0, (window.u1 - k.cx()) / k.fx()};
    top = {1.0, (k.cy() - window.v0 + 1.0) / k.fy()};
    bottom = {-1.0, (window.v1 - k.cy()) / k.fy()};
  }

  Intrinsics intrinsics;
  ViewSide left{}, right{}, top{}, bottom{};  // one pixel outside of the window
  double guard_u, guard_v;                    // pixels from the principal point
};

/// A body's pose as the kernel needs it.
struct BodyFrame {
  Eigen::Isometry3d T_camera_body;
  std::array<float, 12> to_camera;  // 3 x 4 by rows
  std::array<float, 12> to_image;   // 3 x 4 by rows: (u z, v z, z) of a point of the body
  std::array<float, 3> centre;      // the camera's centre in the body's frame
  /// For a triangle's plane n . p = d: 1/z = A u + B v + C with (A, B, C) = rows . n / (d - n .
  /// centre).
  std::array<float, 9> inverse_depth;
  float grazing;    // metres: faces whose plane passes the centre this closely need doubles
  std::int32_t id;  // its number in packed words, 1 and more

  BodyFrame(const Eigen::Isometry3d& T, const Intrinsics& k, std::int32_t body_id);
};

/// A box in the image, pixels.
struct Bounds {
  float u0, v0, u1, v1;
  [[nodiscard]] bool meets(const Bounds& other) const {
    return u0 <= other.u1 && other.u0 <= u1 && v0 <= other.v1 && other.v0 <= v1;
  }
};

/// Around the image of a ball; everywhere if the ball may reach past the near plane.
Bounds bounds_of(const Ball& ball, const BodyFrame& body, const Intrinsics& k);

/// A cluster to draw.
struct DrawItem {
  std::uint32_t cluster;
  std::uint32_t group;
  std::uint32_t body;
  Sides sides;
  bool clip;      // it may reach past the near plane or the guard band
  bool second;    // drawn after the group's others, which are likely to hide it
  float nearest;  // 1/z that no point of it exceeds; infinite if it is not to be tested
};

/// A depth buffer in blocks, and scratch space. Each lane holds the bits of a float 1/z whose low
/// bits are replaced by the body's id: larger is nearer, as integers too, so that a maximum is the
/// depth test, and the result does not depend on the order of drawing.
struct Canvas {
  Canvas(const Intrinsics& k, int lanes)
      : touched(k.width(), k.height()),
        blocks_per_row((k.width() + touched.tile_width - 1) / touched.tile_width *
                       (touched.tile_width / block_width)),
        lanes_per_row(static_cast<std::size_t>(blocks_per_row) * static_cast<std::size_t>(lanes)),
        packed(lanes_per_row * touched.rows.size() *
               static_cast<std::size_t>(TileMask::tile_height * block_width / lanes)) {}

  TileMask touched;
  int blocks_per_row;
  std::size_t lanes_per_row;
  AlignedVector<std::int32_t> packed;
};

/// Where the frame's images go; rows are padded so that whole tiles may be written.
struct Output {
  float* depth;
  std::uint16_t* links;
  std::size_t stride;  // elements
};

/// Splits packed words into depth and id.
struct Packing {
  explicit Packing(std::size_t bodies)
      : id_mask((std::int32_t{1} << std::bit_width(bodies)) - 1), half_step((id_mask + 1) >> 1) {}
  std::int32_t id_mask;
  std::int32_t half_step;  // stands for the lost low bits of 1/z: their middle
};

/// A plane's inverse depth 1/z = base + du (u - u0) + dv (v - v0).
struct InverseDepth {
  float base, du, dv;
};

/// InverseDepth of triangle `triangle` of a cluster, in double, for faces seen almost edge-on: a
/// plane through the camera's centre has none, and its triangle's mean depth stands for it.
InverseDepth grazing_inverse_depth(const ClusteredScene& scene, const Cluster& cluster,
                                   std::uint32_t triangle, const BodyFrame& body, const View& view,
                                   double u0, double v0);

/// A convex polygon in the image, pixels.
struct ClippedPolygon {
  static constexpr int max_corners = 8;  // a triangle cut by five planes
  int count = 0;
  std::array<std::array<float, 2>, max_corners> corners{};
};

/// The part of a triangle before the near plane and inside the guard band. `corners` are in the
/// camera's frame; `pixels` their image points as the kernel has them, which uncut corners keep, so
/// that edges shared with unclipped triangles stay the same.
ClippedPolygon clip(const std::array<Eigen::Vector3d, 3>& corners,
                    const std::array<std::array<float, 2>, 3>& pixels, const View& view);

}  // namespace penumbra::cpu
