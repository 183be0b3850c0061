// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::io {

/// Writes a binary STL file. Normals are left 0; readers make their own. Throws InputError that
/// names a file that cannot be written.
void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace penumbra::io
