// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::mesh_formats {

/// Appends to `mesh` triangles that cover the polygon of these vertices of it, concave or not
/// quite plane, wound as it is; none for fewer than three corners. Corners on a line give
/// triangles of zero area, so that every edge keeps its neighbour. The indices must be in range.
/// Throws FormatError for a polygon of more than four corners that crosses itself, and for one of
/// more than 4000 corners.
void append_polygon(std::span<const std::uint32_t> corners, TriangleMesh& mesh);

}  // namespace penumbra::mesh_formats
