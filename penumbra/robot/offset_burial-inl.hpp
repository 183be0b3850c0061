// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include <penumbra/robot/triangle_tree-inl.hpp>

namespace penumbra::offset {

/// Tells which round parts of a grown surface lie wholly inside of what other triangles grew to:
/// nothing of the exact surface is theirs, so their form does not matter. Points are tested so
/// densely that nothing between them comes out.
class Burial {
 public:
  Burial(const TriangleMesh& mesh, double margin) : tree_(mesh), margin_(margin) {}

  /// Of the strip around edge a-b between two normals.
  [[nodiscard]] bool hides_edge(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Of the part of vertex p's ball that lies between its faces' normals, in order around `centre`.
  [[nodiscard]] bool hides_corner(const Eigen::Vector3d& p, const Eigen::Vector3d& centre,
                                  std::span<const Eigen::Vector3d> normals) const;

 private:
  [[nodiscard]] bool hides(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool hides_arc(const Eigen::Vector3d& p, const Eigen::Vector3d& from,
                               const Eigen::Vector3d& to) const;

  TriangleTree tree_;
  double margin_;
};

}  // namespace penumbra::offset
