// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// Returns a mesh of fewer triangles whose surface is nowhere farther from the given one than about
/// `error`, metres. Works best on welded meshes.
[[nodiscard]] TriangleMesh simplified(TriangleMesh mesh, double error);

}  // namespace penumbra
