// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// A mesh's triangles in a tree of boxes, corners copied.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Whether a triangle lies nearer to p than `reach`.
  [[nodiscard]] bool comes_within(const Eigen::Vector3d& p, double reach) const;

  /// The surface's point nearest to p; p itself where none is nearer than `reach`.
  [[nodiscard]] Eigen::Vector3d nearest(const Eigen::Vector3d& p, double reach) const;

 private:
  using Corners = std::array<Eigen::Vector3f, 3>;

  struct Node {
    Eigen::AlignedBox3f box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // of triangles of a leaf; 0: children at first and first + 1
  };

  void build(std::vector<Corners>::iterator begin, std::vector<Corners>::iterator end,
             std::uint32_t node);

  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace penumbra::offset
