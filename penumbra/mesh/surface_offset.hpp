// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// Returns a new mesh whose surface lies `margin` metres outside of the given one, or inside of it
/// if the margin is negative. It is sampled on a grid of 3 to 6 mm and then simplified.
///
/// A grown mesh covers the true one but for less than 1 mm at sharp edges. It is larger by at most
/// 2 mm, in creases 4 mm. Open meshes grow on both sides. A shrunk mesh is too large by at most 2
/// mm, in creases, and may miss what is left thinner than the grid; it has no triangles if nothing
/// is.
///
/// Throws InputError if the margin is not finite, if a mesh to shrink is open, and if the mesh is
/// so large that the grid would take millions of cells.
[[nodiscard]] PreparedMesh offset_surface(const PreparedMesh& mesh, double margin);

}  // namespace penumbra
