// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// The distance of an eroded surface from the one it was made of differs from the depth by at most
/// this share of it, measured at corners, and at the middles of sides and faces.
inline constexpr double erosion_error = 0.05;

/// The closed mesh shrunk by `depth` metres: every plane of it moves inwards by `depth` and every
/// vertex to where its planes meet, so that edges stay sharp and triangles keep their number.
///
/// Throws InputError for an open mesh, and where the result would not be within erosion_error of
/// the depth: the body, a part of it or a detail (a rounding of a smaller radius, a thin wall)
/// vanishes.
[[nodiscard]] TriangleMesh erode_surface(const TriangleMesh& welded, double depth);

}  // namespace penumbra::offset
