// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

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

/// Refuses what Assimp would take, or crash on, although it is cut off or points nowhere; returns
/// the triangles that the meshes of a glTF or GLB file count.
[[nodiscard]] std::size_t check_gltf(std::string_view bytes, bool binary);

/// A scene's triangles, and how many its meshes have before nodes repeat them or leave them out.
struct Scene {
  TriangleMesh mesh;
  std::size_t triangles_stored = 0;
};

/// Reads glTF or, from `bytes`, GLB through Assimp. A .gltf opens the buffer files that lie beside
/// `file`.
[[nodiscard]] Scene read_with_assimp(const std::filesystem::path& file, std::string_view bytes,
                                     bool binary);

}  // namespace penumbra::mesh_formats
