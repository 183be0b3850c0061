// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

/// Returns the mesh with vertices of equal position merged (-0.0 equals 0.0), in the order in which
/// triangles use them, and without triangles of zero area or repeated corners. No surface opens by
/// that: the neighbour on the long edge of a triangle of zero area is split at its third corner.
/// Indices must be in range. Takes linear time: five million triangles take seconds.
[[nodiscard]] TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace penumbra
