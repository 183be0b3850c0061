// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <penumbra/render/cpu/frame.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra::cpu {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <std::size_t Size, typename Matrix>
std::array<float, Size> by_rows(const Matrix& m) {
  std::array<float, Size> out;
  std::size_t i = 0;
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    for (Eigen::Index c = 0; c < m.cols(); ++c) out[i++] = static_cast<float>(m(r, c));
  }
  return out;
}

Matrix3d projection(const Intrinsics& k) {
  Matrix3d m;
  m << k.fx(), 0, k.cx(), 0, k.fy(), k.cy(), 0, 0, 1;
  return m;
}

}  // namespace

BodyFrame::BodyFrame(const Eigen::Isometry3d& T, const Intrinsics& k, std::int32_t body_id)
    : T_camera_body(T), id(body_id) {
  const Matrix3d K = projection(k);
  const Vector3d c = -(T.linear().transpose() * T.translation());
  const Eigen::Matrix<double, 3, 4> pose = T.matrix().topRows<3>();
  to_camera = by_rows<12>(pose);
  to_image = by_rows<12>(K * pose);
  centre = by_rows<3>(c);
  inverse_depth = by_rows<9>((T.linear().transpose() * K.inverse()).transpose());
  // Distances of the centre from planes carry errors of some 1e-7 of its coordinates; above this
  // bound their share of the depth stays below 5e-5.
  constexpr double grazing_angle = 4e-3;
  grazing = static_cast<float>(grazing_angle * c.norm());
}

Bounds bounds_of(const Ball& ball, const BodyFrame& body, const Intrinsics& k) {
  const Vector3d p = body.T_camera_body * ball.centre;
  const double front = p.z() - ball.radius;
  const double back = p.z() + ball.radius;
  constexpr float everywhere = std::numeric_limits<float>::infinity();
  if (front < DepthRenderer::near_plane) return {-everywhere, -everywhere, everywhere, everywhere};
  const auto least = [&](double x) {
    return std::min((x - ball.radius) / front, (x - ball.radius) / back);
  };
  const auto most = [&](double x) {
    return std::max((x + ball.radius) / front, (x + ball.radius) / back);
  };
  constexpr double spare = 1.0;  // pixels: roundings of float image points
  return {static_cast<float>(k.fx() * least(p.x()) + k.cx() - spare),
          static_cast<float>(k.fy() * least(p.y()) + k.cy() - spare),
          static_cast<float>(k.fx() * most(p.x()) + k.cx() + spare),
          static_cast<float>(k.fy() * most(p.y()) + k.cy() + spare)};
}

InverseDepth grazing_inverse_depth(const ClusteredScene& scene, const Cluster& cluster,
                                   std::uint32_t triangle, const BodyFrame& body, const View& view,
                                   double u0, double v0) {
  const auto corner = [&](std::uint32_t shift) {
    const std::size_t i = cluster.first_vertex + ((scene.corners[triangle] >> shift) & 255U);
    return Vector3d(body.T_camera_body * Vector3d(scene.x[i], scene.y[i], scene.z[i]));
  };
  const Vector3d a = corner(0);
  const Vector3d b = corner(8);
  const Vector3d c = corner(16);
  const Vector3d n = (b - a).cross(c - a).normalized();
  const double offset = n.dot(a);
  constexpr double edge_on = 1e-9;  // metres: rounding of the double corners
  if (std::abs(offset) < edge_on) {
    const double z = std::max((a.z() + b.z() + c.z()) / 3.0, DepthRenderer::near_plane);
    return {static_cast<float>(1.0 / z), 0.0F, 0.0F};
  }
  const Intrinsics& k = view.intrinsics;
  return {static_cast<float>(n.dot(k.ray(u0, v0)) / offset),
          static_cast<float>(n.x() / (k.fx() * offset)),
          static_cast<float>(n.y() / (k.fy() * offset))};
}

ClippedPolygon clip(const std::array<Vector3d, 3>& corners,
                    const std::array<std::array<float, 2>, 3>& pixels, const View& view) {
  struct Corner {
    Vector3d point;
    int original;  // its index, or -1 for a cut
  };
  const Intrinsics& k = view.intrinsics;
  const double tan_u = view.guard_u / k.fx();
  const double tan_v = view.guard_v / k.fy();
  const std::array<Eigen::Vector4d, 5> planes{
      Eigen::Vector4d(0, 0, 1, -DepthRenderer::near_plane), Eigen::Vector4d(1, 0, tan_u, 0),
      Eigen::Vector4d(-1, 0, tan_u, 0), Eigen::Vector4d(0, 1, tan_v, 0),
      Eigen::Vector4d(0, -1, tan_v, 0)};
  std::array<Corner, ClippedPolygon::max_corners> polygon{
      Corner{corners[0], 0}, Corner{corners[1], 1}, Corner{corners[2], 2}};
  std::size_t count = 3;
  for (const Eigen::Vector4d& plane : planes) {  // Sutherland and Hodgman 1974
    const auto distance = [&](const Corner& c) { return plane.dot(c.point.homogeneous()); };
    std::array<Corner, ClippedPolygon::max_corners> kept;
    std::size_t kept_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Corner& p = polygon[i];
      const Corner& q = polygon[(i + 1) % count];
      const double dp = distance(p);
      const double dq = distance(q);
      if (dp >= 0) kept[kept_count++] = p;
      if ((dp >= 0) == (dq >= 0)) continue;
      // Always from the inside out, so that the triangle on the other side cuts at the same point.
      const auto& [in, out] = dp >= 0 ? std::pair(p, q) : std::pair(q, p);
      const double t = std::max(dp, dq) / std::abs(dp - dq);
      kept[kept_count++] = {in.point + t * (out.point - in.point), -1};
    }
    polygon = kept;
    count = kept_count;
    if (count < 3) return {};
  }
  ClippedPolygon result;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f cut = k.project(polygon[i].point).cast<float>();
    result.corners[i] = polygon[i].original >= 0
                            ? pixels[static_cast<std::size_t>(polygon[i].original)]
                            : std::array<float, 2>{cut.x(), cut.y()};
  }
  result.count = static_cast<int>(count);
  return result;
}

}  // namespace penumbra::cpu
