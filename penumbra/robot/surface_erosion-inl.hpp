// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// A surface made by planes lies from the depth by at most this share of it.
inline constexpr double plane_error = 0.05;

/// The closed mesh shrunk by `depth` metres.
///
/// Every plane of it moves inwards by `depth` and every vertex to where its planes meet, so that
/// edges stay sharp and triangles keep their number. Where details, walls or parts vanish on the
/// way the result is taken from a grid. Throws InputError for an open mesh, where nothing is left,
/// and where the grid would need too many cells to keep its bound.
[[nodiscard]] TriangleMesh erode_surface(const TriangleMesh& welded, double depth);

}  // namespace penumbra::offset
