// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// Reads the triangles of a mesh file: STL (binary, ASCII), DAE, OBJ, PLY, glTF, GLB, by its
/// extension in either case. Welds vertices, drops degenerate triangles and cuts polygons into
/// triangles; ignores lines, points, materials and textures.
///
/// Metres: STL, OBJ and PLY as they are; Collada's <unit> is applied and its <up_axis> ignored, as
/// RViz does; glTF's y-up is kept, as RViz does. Transforms of nodes are applied; the triangles of
/// mirrored nodes are reversed.
///
/// Throws InputError that names file, reason and remedy if the file cannot be read completely: it
/// does not exist, is truncated (as far as the format shows it), has no triangles, has a coordinate
/// that is not finite or beyond 1e6, or uses features that are not supported (skins, morphs,
/// Collada's skew, glTF's compression, instancing and rotations of another length than 1, OBJ
/// vertices with a fourth coordinate other than 1).
[[nodiscard]] TriangleMesh load_mesh(const std::filesystem::path& file);

}  // namespace penumbra
