// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <penumbra/render/cpu/sliver.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::cpu {
namespace {

using Eigen::Vector3d;

std::array<Vector3d, 3> corners_in_camera(const ClusteredScene& scene, const Cluster& cluster,
                                          std::uint32_t triangle, const BodyFrame& body) {
  std::array<Vector3d, 3> corners;
  for (std::uint32_t j = 0; j < 3; ++j) {
    const std::size_t i = cluster.first_vertex + ((scene.corners[triangle] >> (8 * j)) & 255U);
    corners[j] = body.T_camera_body * Vector3d(scene.x[i], scene.y[i], scene.z[i]);
  }
  return corners;
}

}  // namespace

bool has_area(const ImageCorners& corners) {
  // Differences of floats and their products fit into doubles, mostly without rounding.
  const std::array<double, 6> p{corners[0], corners[1], corners[2],
                                corners[3], corners[4], corners[5]};
  return (p[3] - p[1]) * (p[4] - p[0]) - (p[2] - p[0]) * (p[5] - p[1]) > 0.0;
}

bool is_upright(const ImageCorners& corners) {
  const auto [u_min, u_max] = std::minmax({corners[0], corners[2], corners[4]});
  const auto [v_min, v_max] = std::minmax({corners[1], corners[3], corners[5]});
  return v_max - v_min > u_max - u_min;
}

Sliver::Sliver(const FrameContext& frame, std::uint32_t cluster, std::uint32_t triangle,
               const BodyFrame& body, const ImageCorners& corners)
    : intrinsics_(frame.view->intrinsics),
      image_(corners),
      upright_(is_upright(corners)),
      corners_(corners_in_camera(*frame.scene, frame.scene->clusters[cluster], triangle, body)),
      normal_((corners_[1] - corners_[0]).cross(corners_[2] - corners_[0]).normalized()),
      offset_(normal_.dot(corners_[0])) {}

float Sliver::inverse_depth(int u, int v) const {
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t k = (j + 1) % 3;
    const double pu = image_[2 * j] - static_cast<double>(u);
    const double pv = image_[2 * j + 1] - static_cast<double>(v);
    const double qu = image_[2 * k] - static_cast<double>(u);
    const double qv = image_[2 * k + 1] - static_cast<double>(v);
    // With p and q changed over it is the same but for its sign: no cracks between slivers.
    if (pv * qu - pu * qv < 0.0) return 0.0F;
  }
  const Depths depths = crossing(u, v);
  constexpr double edge_on = 1e-9;  // metres: rounding of the double corners
  const double inverse = normal_.dot(intrinsics_.ray(u, v)) / offset_;
  // In a plane through the camera's centre a ray meets the near side first.
  const bool has_depth = std::abs(offset_) >= edge_on && inverse > 0.0;
  const double z = has_depth ? std::clamp(1.0 / inverse, depths.low, depths.high) : depths.low;
  return static_cast<float>(1.0 / std::max(z, DepthRenderer::near_plane));
}

Sliver::Depths Sliver::crossing(int u, int v) const {
  const Intrinsics& k = intrinsics_;
  const auto aside = [&](const Vector3d& p) {
    return upright_ ? k.fy() * p.y() + (k.cy() - v) * p.z() : k.fx() * p.x() + (k.cx() - u) * p.z();
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Depths depths{infinity, -infinity};
  double nearest = infinity;
  double nearest_z = DepthRenderer::near_plane;
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3d& p = corners_[j];
    const Vector3d& q = corners_[(j + 1) % 3];
    const double a = aside(p);
    const double b = aside(q);
    if (p.z() >= DepthRenderer::near_plane && std::abs(a) < nearest * p.z()) {
      nearest = std::abs(a) / p.z();
      nearest_z = p.z();
    }
    if (a * b > 0.0 || a == b) continue;
    const double z = p.z() + (q.z() - p.z()) * (a / (a - b));
    depths = {std::min(depths.low, z), std::max(depths.high, z)};
  }
  // A pixel at its very tip, whose image point was rounded.
  return depths.low <= depths.high ? depths : Depths{nearest_z, nearest_z};
}

}  // namespace penumbra::cpu
