// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <Eigen/Geometry>

#include <penumbra/base/triangle_mesh.hpp>

/// Brute force over all triangles, in double.
namespace penumbra::test {

using Eigen::Vector3d;

inline std::array<Vector3d, 3> corners(const TriangleMesh& mesh, std::size_t i) {
  const auto& t = mesh.triangles[i];
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
          mesh.vertices[t[2]].cast<double>()};
}

inline double segment_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

inline double triangle_distance(const Vector3d& p, const std::array<Vector3d, 3>& t) {
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool inside = true;
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& a = t[k];
    const Vector3d& b = t[(k + 1) % 3];
    inside = inside && (b - a).cross(p - a).dot(n) >= 0.0;
    distance = std::min(distance, segment_distance(p, a, b));
  }
  return inside ? std::abs((p - t[0]).dot(n)) : distance;
}

inline double distance(const TriangleMesh& mesh, const Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    nearest = std::min(nearest, triangle_distance(p, corners(mesh, i)));
  return nearest;
}

/// First hit of a ray with either side, or with fronts only.
inline std::optional<Vector3d> cast(const TriangleMesh& mesh, const Vector3d& eye,
                                    const Vector3d& ray, bool cull_backs) {
  std::optional<Vector3d> hit;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = corners(mesh, i);
    // Edge functions of the corners seen from the eye: exact signs on shared edges do not matter
    // to a few thousand random rays.
    const Vector3d p = a - eye;
    const Vector3d q = b - eye;
    const Vector3d r = c - eye;
    const double u = ray.dot(q.cross(r));
    const double v = ray.dot(r.cross(p));
    const double w = ray.dot(p.cross(q));
    const bool front = u <= 0.0 && v <= 0.0 && w <= 0.0;
    const bool back = u >= 0.0 && v >= 0.0 && w >= 0.0;
    const double sum = u + v + w;
    if ((!front && (cull_backs || !back)) || sum == 0.0) continue;
    const double t = (u * p + v * q + w * r).dot(ray) / sum;
    if (t <= 0.0 || t >= nearest) continue;
    nearest = t;
    hit = eye + t * ray;
  }
  return hit;
}

/// Whether a ray comes within `reach` of the mesh, by steps that cannot jump over it.
inline bool comes_within(const TriangleMesh& mesh, const Vector3d& eye, const Vector3d& ray,
                         double reach, double length) {
  for (double t = 0.0; t < length;) {
    const double gap = distance(mesh, eye + t * ray) - reach;
    if (gap < 0.0) return true;
    t += std::max(gap, 1e-7);
  }
  return false;
}

inline Vector3d random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

}  // namespace penumbra::test
