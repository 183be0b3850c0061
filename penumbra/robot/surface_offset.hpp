// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra {

/// Returns a new mesh whose surface lies `margin` metres outside of the given one, or inside of it
/// if the margin is negative. It is sampled on a grid of 3 to 8 mm and then simplified.
///
/// A grown mesh covers all points within the margin, but for up to 0.5 mm at sharp edges if the
/// margin is below 5 mm; it is larger by at most 1.5 mm, in creases by a few millimetres more. Open
/// meshes grow on both sides and come out closed. A shrunk mesh is at most 1 mm too large, and
/// misses what is left thinner than the grid.
///
/// Throws InputError if the margin is not finite, if a mesh to shrink is open, and if the mesh is
/// so large that the grid would take millions of cells.
[[nodiscard]] TriangleMesh offset_surface(const TriangleMesh& mesh, double margin);

}  // namespace penumbra
