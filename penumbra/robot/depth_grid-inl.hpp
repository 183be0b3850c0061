// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/triangle_mesh.hpp>
#include <penumbra/robot/triangle_tree-inl.hpp>

namespace penumbra::offset {

/// The corners of a cubic grid near the surface that lies `depth` inside a solid, and which of them
/// are deeper than it.
class DepthGrid {
 public:
  using Index = Eigen::Vector3i;

  struct Corner {
    Eigen::Vector3f nearest;  // of the solid's surface
    float distance;           // to it
    bool deep;                // inside, and the distance is at least the depth
  };

  /// Keeps references. `solid` closed and wound outwards; `cell` metres, below the depth. Stops at
  /// `most_cells`.
  DepthGrid(const TriangleMesh& solid, const TriangleTree& tree, double depth, double cell,
            std::size_t most_cells);

  /// Whether the surface fits into the cells allowed; else there are no cells.
  [[nodiscard]] bool fits() const { return fits_; }
  /// The lower corners of all cells through which the surface runs, and of some more.
  [[nodiscard]] const std::vector<Index>& cells() const { return cells_; }
  /// A corner of one of the cells.
  [[nodiscard]] const Corner& corner(const Index& i) const { return corners_.at(key(i)); }
  [[nodiscard]] Eigen::Vector3d position(const Index& i) const {
    return origin_ + cell_ * i.cast<double>();
  }
  [[nodiscard]] double cell() const { return cell_; }
  /// Whether the solid has a point deeper than `most` in a cell without a deep corner: a part of it
  /// slipped through between the corners.
  [[nodiscard]] bool misses(double most) const;
  [[nodiscard]] static std::uint64_t key(const Index& i);

 private:
  struct Block {
    Index lower;
    double distance;  // of its centre
  };

  void collect_blocks(const Index& lower, int side, double reach);
  void drop_outer_blocks();
  void sample(const Block& block);
  void drop_outer_corners();
  [[nodiscard]] bool has_deeper(const Eigen::Vector3d& centre, double side, double most) const;

  const TriangleMesh& solid_;
  const TriangleTree& tree_;
  double depth_;
  double cell_;
  Eigen::Vector3d origin_;
  std::size_t most_blocks_;
  bool fits_ = true;
  std::vector<Block> blocks_;
  std::vector<Index> cells_;
  std::unordered_map<std::uint64_t, Corner> corners_;
};

}  // namespace penumbra::offset
