// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/robot/depth_grid-inl.hpp>

namespace penumbra::offset {

/// The surface at `depth` through the cells of `grid`: closed, wound outwards, one vertex in each
/// cell, on the surface and on its creases where they run through the cell (dual contouring of
/// Hermite data, Ju et al. 2002).
[[nodiscard]] TriangleMesh extract_surface(const DepthGrid& grid, const TriangleTree& tree,
                                           double depth);

}  // namespace penumbra::offset
