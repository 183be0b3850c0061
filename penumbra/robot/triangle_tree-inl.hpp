// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// A mesh's triangles in a tree of boxes. Keeps a reference to the mesh.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Whether a triangle lies nearer to p than `reach`.
  [[nodiscard]] bool comes_within(const Eigen::Vector3d& p, double reach) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // of triangles of a leaf; 0: children at first and first + 1
  };

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  [[nodiscard]] double squared_distance(const Eigen::Vector3d& p, std::uint32_t triangle) const;

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<Node> nodes_;
};

}  // namespace penumbra::offset
