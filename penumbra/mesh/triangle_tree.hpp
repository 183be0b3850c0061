// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// A tree of boxes over a mesh's triangles, for rays and distances. Immutable.
class TriangleTree {
 public:
  static constexpr double nowhere = std::numeric_limits<double>::infinity();

  explicit TriangleTree(const PreparedMesh& mesh);

  /// Returns t of the first point origin + t * direction on a triangle, seen from either side, with
  /// 0 < t < limit; nowhere if there is none. A ray through an edge that two triangles share meets
  /// at least one of them.
  [[nodiscard]] double first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                 double limit = nowhere) const;

  /// Returns the distance from a point to the nearest triangle if it is below limit, else nowhere.
  [[nodiscard]] double distance(const Eigen::Vector3d& point, double limit = nowhere) const;

  /// Returns whether patches that bound a body, with small holes at most, enclose a point.
  [[nodiscard]] bool encloses(const Eigen::Vector3d& point) const;

 private:
  using Corners = std::array<Eigen::Vector3f, 3>;

  struct Node {
    Eigen::AlignedBox3f box;
    std::uint32_t first = 0;  // triangle of a leaf; second child of another node, the first is next
    std::uint32_t count = 0;  // triangles of a leaf; 0: not a leaf
  };

  /// Returns how often the patches wind around a point, counted along a ray.
  [[nodiscard]] int winding(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
  void add_node(const std::vector<Corners>& corners, std::vector<std::uint32_t>& order,
                std::uint32_t first, std::uint32_t end);

  /// Calls f(triangle) for all in boxes for which enters(box) holds.
  template <typename Enters, typename F>
  void visit(const Enters& enters, const F& f) const;

  std::vector<Node> nodes_;
  std::vector<Corners> triangles_;   // in the order of the leaves
  std::vector<std::int8_t> facing_;  // 1: wound outwards, -1: inwards, 0: not known
};

}  // namespace penumbra
