// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// In place of a half-edge, a side or a vertex.
inline constexpr std::uint32_t none = ~std::uint32_t{0};

/// The sides of a mesh's triangles that face free space, glued along their edges into closed,
/// oriented surfaces: the fronts of closed pieces; fronts and backs of open ones, glued around
/// each edge to the next side across empty space.
///
/// Half-edge 3 * side + k starts at corner k of its side and runs to corner k + 1.
struct MeshSides {
  std::vector<std::uint32_t> start;     // per half-edge: the vertex where it starts
  std::vector<std::uint32_t> twin;      // per half-edge: the one that runs the edge backwards
  std::vector<Eigen::Vector3f> middle;  // per half-edge: unit, halves the empty wedge at the edge
  std::vector<Eigen::Vector3d> normal;  // per side: unit, away from the material

  [[nodiscard]] std::size_t count() const { return normal.size(); }
  [[nodiscard]] static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  [[nodiscard]] static std::uint32_t previous(std::uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
  }
};

/// `welded` as weld() returns it.
[[nodiscard]] MeshSides collect_sides(const TriangleMesh& welded);

}  // namespace penumbra::offset
