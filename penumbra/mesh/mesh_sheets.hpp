// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

/// A ball in the mesh's frame, metres.
struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

/// Which way a sheet's fronts face.
enum class Facing { unknown, outwards, inwards };

/// A piece of a mesh whose triangles hang together by edges that exactly two of them share and run
/// in opposite ways, so that its sides can be told apart everywhere.
struct MeshSheet {
  static constexpr std::size_t least_samples = 4;

  std::vector<std::size_t> triangles;  ///< indices into TriangleMesh::triangles
  bool closed = false;

  /// Known where the sheet bounds a body but for small holes. A ray from outside then meets, of
  /// this sheet, an outer side first, unless it went through the ball of a hole before or meets a
  /// triangle that touches one. (Points of the sheet are tried for that, no fewer than
  /// least_samples: a sheet that crosses itself so that less than some hundredth of it shows its
  /// back may pass.)
  Facing facing = Facing::unknown;

  /// Balls around the rims of the sheet's holes; empty where it is closed or `facing` is unknown.
  std::vector<Ball> holes;
};

/// The sheets of a welded mesh, in the same order, without `facing` and `holes`, which cost most.
[[nodiscard]] std::vector<MeshSheet> split_sheets(const TriangleMesh& welded);

/// The sheets of a welded mesh, ordered by their first triangle. A sheet's holes are small where
/// their radii add up to an eighth of its size at most, and there are few.
[[nodiscard]] std::vector<MeshSheet> mesh_sheets(const TriangleMesh& welded);

}  // namespace penumbra
