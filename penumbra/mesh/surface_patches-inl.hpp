// SPDX-License-Identifier: Apache-2.0
// The parts of PreparedMesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Core>

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

/// Returns the orientation of every patch of a mesh.
[[nodiscard]] std::vector<PatchOrientation> orient(const PreparedMesh& mesh,
                                                   const Connections& connections);

}  // namespace penumbra
