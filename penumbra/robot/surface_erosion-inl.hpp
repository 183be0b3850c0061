// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra::offset {

/// The closed mesh shrunk by `depth` metres. Throws InputError where that cannot be done.
[[nodiscard]] TriangleMesh erode_surface(const TriangleMesh& welded, double depth);

}  // namespace penumbra::offset
