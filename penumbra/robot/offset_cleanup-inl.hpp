// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// Removes triangles that lie on each other and look opposite ways: what is hidden folds up so.
void cancel_opposites(TriangleMesh& mesh);

/// Splits edges at which several pairs of triangles meet, each pair at a point of its own, so that
/// every edge has one pair and the mesh counts as closed.
void separate_edges(TriangleMesh& mesh);

/// Moves vertices of equal position apart by float steps, so that weld() keeps them apart.
void separate_vertices(TriangleMesh& mesh);

/// Removes steps of a closed loop of vertices that are taken back at once.
void drop_returns(std::vector<std::uint32_t>& loop);

}  // namespace penumbra::offset
