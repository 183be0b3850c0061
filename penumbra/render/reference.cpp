// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <penumbra/base/image.hpp>
#include <penumbra/render/backends-inl.hpp>

namespace penumbra {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct PixelBounds {
  int u0, v0, u1, v1;  // inclusive
  [[nodiscard]] bool empty() const { return u0 > u1 || v0 > v1; }
};

/// Rasterises in homogeneous coordinates (Olano and Greer 1997, "Triangle scan conversion using 2D
/// homogeneous coordinates"): a ray r hits the triangle abc where r . (a x b), r . (b x c) and
/// r . (c x a) have one sign, at depth z = n . a / n . r with n = (b - a) x (c - a) and r.z = 1. No
/// vertex is divided by its depth, so that triangles through the camera plane need no clipping, and
/// an edge shared by two triangles gives both the same value but for its sign: no cracks.
class ReferenceRenderer final : public DepthRenderer {
 public:
  ReferenceRenderer(const Intrinsics& intrinsics, std::span<const Body> bodies)
      : DepthRenderer(intrinsics, bodies, {.backend = Backend::reference, .isa = "scalar"}),
        depth_(intrinsics.width(), intrinsics.height()),
        links_(intrinsics.width(), intrinsics.height()),
        touched_(intrinsics.width(), intrinsics.height()) {
    for (const Body& body : bodies) meshes_.emplace_back(body.meshes.begin(), body.meshes.end());
  }

 private:
  void do_submit(std::span<const Isometry3d> T_camera_body,
                 const PixelRectangle& /*window*/) override {
    std::fill_n(depth_.data(), depth_.size(), 0.0F);
    std::fill_n(links_.data(), links_.size(), std::uint16_t{0});
    std::fill(touched_.rows.begin(), touched_.rows.end(), std::uint64_t{0});
    for (std::size_t body = 0; body < meshes_.size(); ++body) {
      for (const TriangleMesh& mesh : meshes_[body]) draw(mesh, T_camera_body[body], body);
    }
  }

  VirtualDepthView do_collect() override { return {depth_.view(), links_.view(), &touched_}; }

  void draw(const TriangleMesh& mesh, const Isometry3d& T_camera_body, std::size_t body) {
    points_.clear();
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      points_.push_back(T_camera_body * vertex.cast<double>());
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      draw({points_[a], points_[b], points_[c]}, static_cast<std::uint16_t>(body + 1));
    }
  }

  void draw(const std::array<Vector3d, 3>& corners, std::uint16_t link) {
    const PixelBounds box = bounds(corners);
    if (box.empty()) return;
    const auto& [a, b, c] = corners;
    const Vector3d ab = a.cross(b);
    const Vector3d bc = b.cross(c);
    const Vector3d ca = c.cross(a);
    const Vector3d normal = (b - a).cross(c - a);
    const double offset = normal.dot(a);
    const auto [z_min, z_max] = std::minmax({a.z(), b.z(), c.z()});
    for (int v = box.v0; v <= box.v1; ++v) {
      for (int u = box.u0; u <= box.u1; ++u) {
        const Vector3d ray = intrinsics().ray(u, v);
        const double e0 = ray.dot(ab);
        const double e1 = ray.dot(bc);
        const double e2 = ray.dot(ca);
        const bool inside = (e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0);
        const double slope = normal.dot(ray);
        if (!inside || slope == 0.0) continue;  // seen edge-on: its neighbours cover the pixel
        const double z = std::clamp(offset / slope, z_min, z_max);
        if (z >= near_plane) keep_nearest(u, v, static_cast<float>(z), link);
      }
    }
    touched_.mark(box.u0, box.v0, box.u1, box.v1);
  }

  void keep_nearest(int u, int v, float z, std::uint16_t link) {
    float& depth = depth_(u, v);
    if (depth != 0.0F && depth <= z) return;
    depth = z;
    links_(u, v) = link;
  }

  /// Pixels that the part of the triangle before the near plane may cover, cut to the image.
  [[nodiscard]] PixelBounds bounds(const std::array<Vector3d, 3>& corners) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vector2d low(infinity, infinity);
    Vector2d high(-infinity, -infinity);
    const auto include = [&](const Vector3d& p) {
      const Vector2d pixel = intrinsics().project(p);
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& p = corners[i];
      const Vector3d& q = corners[(i + 1) % 3];
      if (p.z() >= near_plane) include(p);
      if ((p.z() >= near_plane) != (q.z() >= near_plane)) {
        Vector3d cut = p + (q - p) * ((near_plane - p.z()) / (q.z() - p.z()));
        cut.z() = near_plane;
        include(cut);
      }
    }
    // One pixel to spare: the projection rounds, the exact test follows.
    const auto down = [](double x, int limit) {
      return static_cast<int>(std::clamp(std::ceil(x) - 1.0, 0.0, static_cast<double>(limit)));
    };
    const auto up = [](double x, int limit) {
      return static_cast<int>(std::clamp(std::floor(x) + 1.0, -1.0, limit - 1.0));
    };
    return {down(low.x(), intrinsics().width()), down(low.y(), intrinsics().height()),
            up(high.x(), intrinsics().width()), up(high.y(), intrinsics().height())};
  }

  std::vector<std::vector<TriangleMesh>> meshes_;  // per body
  std::vector<Vector3d> points_;
  Image<float> depth_;
  Image<std::uint16_t> links_;
  TileMask touched_;
};

}  // namespace

std::unique_ptr<DepthRenderer> make_reference_renderer(const Intrinsics& intrinsics,
                                                       std::span<const Body> bodies) {
  return std::make_unique<ReferenceRenderer>(intrinsics, bodies);
}

}  // namespace penumbra
