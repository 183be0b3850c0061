// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// Returns a mesh whose surface lies `margin` metres outside of the given one, or inside if the
/// margin is negative, sampled on a grid of 3 to 6 mm and then simplified.
///
/// A grown mesh covers the exact offset except for less than 1 mm at sharp edges, and is larger by
/// at most 2 mm, in creases 4 mm. Open meshes grow on both sides. A shrunk mesh is too large by at
/// most 2 mm, in creases, may lack parts thinner than the grid, and has no triangles if nothing is
/// left.
///
/// Throws InputError if the margin is not finite, if an open mesh is to shrink, and if the mesh is
/// so large that the grid would have millions of cells.
[[nodiscard]] PreparedMesh offset_surface(const PreparedMesh& mesh, double margin);

}  // namespace penumbra
