// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

/// Reads the triangles of a mesh file: STL (binary, ASCII), DAE, OBJ, PLY, glTF, GLB; the ending
/// decides, in either case. Vertices are welded, degenerate triangles dropped, polygons cut into
/// triangles; lines, points, materials and textures are not looked at.
///
/// Metres: STL, OBJ and PLY as they are; Collada's <unit> is applied and its <up_axis> ignored, as
/// RViz does; glTF's y-up is kept (its z is not turned up), as RViz does. Transforms of nodes are
/// applied; what they mirror is wound again. What bends or repeats a mesh in ways that are not read
/// (skins, morphs, Collada's skew, glTF's compression, instancing and rotations of another length
/// than 1) is an error, as is an OBJ vertex with a fourth coordinate other than 1.
///
/// Throws InputError naming file, reason and remedy for whatever cannot be read whole: no such
/// file, truncated as far as the format shows it, no triangles, a coordinate that is not finite or
/// beyond 1e6 (a robot of a kilometre, in millimetres that a URDF's scale turns into metres).
[[nodiscard]] TriangleMesh load_mesh(const std::filesystem::path& file);

/// The same; appends to `notes` what looks odd and may be right, a line each that names the file.
[[nodiscard]] TriangleMesh load_mesh(const std::filesystem::path& file,
                                     std::vector<std::string>& notes);

}  // namespace penumbra
