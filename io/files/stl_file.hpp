// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra::io {

/// What the files begin with.
inline constexpr const char* stl_begin = "penumbra";

/// Writes a binary STL file with normals of 0, which readers compute themselves. Throws InputError
/// that names a file that cannot be written.
void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace penumbra::io
