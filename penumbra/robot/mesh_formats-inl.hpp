// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <penumbra/base/triangle_mesh.hpp>

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

/// Throws FormatError for a polygon of more corners than are cut into triangles: the time that it
/// takes grows with their square.
inline void check_corners(std::uint64_t corners) {
  constexpr std::uint64_t most = 4000;
  if (corners > most)
    throw FormatError("a polygon has " + std::to_string(corners) + " corners, more than " +
                      std::to_string(most) + "; export the mesh as triangles");
}

/// Of all instances: a file that unfolds to more is an attack or a mistake.
inline constexpr std::size_t most_triangles = 100'000'000;

[[nodiscard]] TriangleMesh read_stl(std::string_view bytes);

/// Reads what a Collada file's scene shows; what it does not know about geometry it refuses.
[[nodiscard]] TriangleMesh read_collada(std::string_view bytes);

/// Refuse what Assimp would take, or crash on, although it is cut off or points nowhere.
void check_ply(std::string_view bytes);

/// The same for OBJ; returns what may be a truncation and may be none, in words, or nothing.
[[nodiscard]] std::string check_obj(std::string_view bytes);

/// The vertices' places and faces' corners alone of an OBJ that was checked, written anew. Assimp
/// takes an OBJ itself for the material file that it names where there is none, and crashes on what
/// stands in it; vertices it drops or scales by how many words of their lines look like numbers.
[[nodiscard]] std::string surface_of_obj(std::string_view bytes);

/// The same for glTF and GLB; returns the triangles that the file's meshes count.
[[nodiscard]] std::size_t check_gltf(std::string_view bytes, bool binary);

/// A scene's triangles, and how many its meshes have before nodes repeat them or leave them out.
struct Scene {
  TriangleMesh mesh;
  std::size_t triangles_stored = 0;
};

/// Reads through Assimp; `ending` is lower case without the dot. A .gltf opens the buffer files
/// that lie beside `file`; everything else is read from `bytes`.
[[nodiscard]] Scene read_with_assimp(const std::filesystem::path& file, std::string_view bytes,
                                     const std::string& ending);

}  // namespace penumbra::mesh_formats
