// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

/// The mesh with vertices of equal position merged (-0.0 equals 0.0), in the order in which
/// triangles use them, and triangles of zero area or repeated corners removed; no piece opens by
/// that: the neighbour on the long edge of a triangle of zero area is split at its third corner.
/// Indices must be in range. Linear in time: five million triangles take seconds.
[[nodiscard]] TriangleMesh weld(const TriangleMesh& mesh);

/// One piece of a mesh whose triangles hang together by shared edges.
struct MeshComponent {
  std::vector<std::size_t> triangles;  ///< indices into TriangleMesh::triangles
  bool closed = false;  ///< every edge has exactly two triangles, which run it in opposite ways
  double signed_volume = 0.0;  ///< cubic metres; positive where a closed piece is wound outwards,
                               ///< without meaning for an open one
};

/// Components of a welded mesh, ordered by their first triangle. An edge of more than two triangles
/// joins them all and is not closed.
[[nodiscard]] std::vector<MeshComponent> connected_components(const TriangleMesh& welded);

/// Whether every component is closed; false for an empty mesh.
[[nodiscard]] bool is_watertight(const TriangleMesh& welded);

}  // namespace penumbra
