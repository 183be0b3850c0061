// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/mesh/prepared_mesh.hpp>

/// Sums and brute force over all triangles, in double.
namespace penumbra::test {

inline std::array<Vector3d, 3> corners(const TriangleMesh& mesh, std::size_t i) {
  const auto& t = mesh.triangles[i];
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
          mesh.vertices[t[2]].cast<double>()};
}

/// Returns the volume of closed meshes, cubic metres; positive if they are wound outwards.
inline double signed_volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vector3d eye = mesh.vertices.front().cast<double>();
    const auto [a, b, c] = corners(mesh, i);
    sum += (a - eye).dot((b - eye).cross(c - eye));
  }
  return sum / 6.0;
}

inline double segment_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

inline double triangle_distance(const Vector3d& p, const std::array<Vector3d, 3>& t) {
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool inside = true;
  double distance = inf;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& a = t[k];
    const Vector3d& b = t[(k + 1) % 3];
    inside = inside && (b - a).cross(p - a).dot(n) >= 0.0;
    distance = std::min(distance, segment_distance(p, a, b));
  }
  return inside ? std::abs((p - t[0]).dot(n)) : distance;
}

inline double distance(const TriangleMesh& mesh, const Vector3d& p) {
  double nearest = inf;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    nearest = std::min(nearest, triangle_distance(p, corners(mesh, i)));
  return nearest;
}

/// Where p + t * ray meets each triangle, at t > 0, and whether the ray leaves by its front.
struct Crossing {
  double t;
  bool leaves;
};
inline std::vector<Crossing> crossings(const TriangleMesh& mesh, const Vector3d& p,
                                       const Vector3d& ray) {
  std::vector<Crossing> all;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    auto [a, b, c] = corners(mesh, i);
    a -= p;
    b -= p;
    c -= p;
    // Signs on shared edges do not matter to random rays.
    const double u = ray.dot(b.cross(c)), v = ray.dot(c.cross(a)), w = ray.dot(a.cross(b));
    const bool leaves = u > 0.0 && v > 0.0 && w > 0.0;
    if (!leaves && !(u < 0.0 && v < 0.0 && w < 0.0)) continue;
    const double t = (u * a + v * b + w * c).dot(ray) / ((u + v + w) * ray.squaredNorm());
    if (t > 0.0) all.push_back({t, leaves});
  }
  return all;
}

/// How often a mesh surrounds p.
inline int windings(const TriangleMesh& mesh, const Vector3d& p) {
  int sum = 0;
  for (const Crossing& crossing : crossings(mesh, p, {0.5412, 0.3127, 0.7806}))
    sum += crossing.leaves ? 1 : -1;
  return sum;
}

/// A point of the mesh, with equal chances for every triangle.
inline Vector3d random_point(const TriangleMesh& mesh, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto [a, b, c] = corners(mesh, random() % mesh.triangles.size());
  const double u = std::sqrt(share(random)), v = share(random);
  return (1 - u) * a + u * (1 - v) * b + u * v * c;
}

}  // namespace penumbra::test
