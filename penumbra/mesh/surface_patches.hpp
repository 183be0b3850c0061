// SPDX-License-Identifier: Apache-2.0
// The parts of PreparedMesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// Disjoint sets of numbers; a set is named by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Returns whether they were in different sets.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// An edge of a triangle that is not regular, in the triangle's direction.
struct RimEdge {
  std::uint32_t triangle, from, to;
};

/// How the triangles of a mesh are connected.
struct Connections {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> regular;  ///< triangles that share an edge
  std::vector<RimEdge> rim;
};

/// Returns the corners of a triangle.
inline std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(),
          mesh.vertices[c].cast<double>()};
}

inline double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                  const Eigen::Vector3d& b) {
  const double t = (p - a).dot(b - a) / (b - a).squaredNorm();
  return (a + std::clamp(t, 0.0, 1.0) * (b - a) - p).norm();
}

inline double distance_to_triangle(const Eigen::Vector3d& p,
                                   const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const bool above = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                     n.dot((a - c).cross(p - c)) >= 0;
  if (above) return std::abs(n.dot(p - a)) / n.norm();
  return std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

/// Returns the solid angle of a triangle seen from `eye`, steradians; positive if `eye` sees its
/// back, so that a closed surface with outward triangles gives 4 pi from inside (van Oosterom and
/// Strackee 1983, "The solid angle of a plane triangle").
inline double solid_angle(const std::array<Eigen::Vector3d, 3>& corners,
                          const Eigen::Vector3d& eye) {
  const Eigen::Vector3d a = corners[0] - eye;
  const Eigen::Vector3d b = corners[1] - eye;
  const Eigen::Vector3d c = corners[2] - eye;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Returns the orientation of every patch of a mesh.
[[nodiscard]] std::vector<PatchOrientation> orient(const PreparedMesh& mesh,
                                                   const Connections& connections);

}  // namespace penumbra
