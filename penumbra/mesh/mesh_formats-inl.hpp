// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::mesh_formats {

/// What is wrong with a file's bytes, and what would be right; the caller adds the file's name.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws FormatError of a file that was cut off or altered.
[[noreturn]] inline void damaged(const std::string& what) {
  throw FormatError(what + "; it is truncated or damaged; export or copy it again");
}

/// Of all instances: a file that unfolds to more is an attack or a mistake.
inline constexpr std::size_t most_triangles = 100'000'000;

[[nodiscard]] TriangleMesh read_stl(std::string_view bytes);

/// Reads what a Collada file's scene shows; what it does not know about geometry it refuses.
[[nodiscard]] TriangleMesh read_collada(std::string_view bytes);

[[nodiscard]] TriangleMesh read_ply(std::string_view bytes);

/// Sets `oddity` to what may be a truncation and may be none, in words.
[[nodiscard]] TriangleMesh read_obj(std::string_view bytes, std::string& oddity);

/// Reads what the scene of a .gltf or, if `binary`, a .glb file shows. Opens the buffer files next
/// to `file`.
[[nodiscard]] TriangleMesh read_gltf(const std::filesystem::path& file, std::string_view bytes,
                                     bool binary);

/// Appends a part of a scene at its pose; a mirrored part is turned outside out again. Throws
/// FormatError if the mesh would have more than most_triangles.
void append_placed(const TriangleMesh& part, const Eigen::Affine3d& T_file_part,
                   TriangleMesh& mesh);

}  // namespace penumbra::mesh_formats
