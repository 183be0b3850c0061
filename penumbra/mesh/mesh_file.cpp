// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/base/whole_file-inl.hpp>
#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/mesh_formats.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra {

void mesh_formats::append_placed(const TriangleMesh& part, const Eigen::Affine3d& T_file_part,
                                 TriangleMesh& mesh) {
  if (mesh.triangles.size() + part.triangles.size() > most_triangles ||
      mesh.vertices.size() + part.vertices.size() > 3 * most_triangles)
    throw FormatError("more than " + std::to_string(most_triangles) +
                      " triangles; export a simplified mesh");
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const bool mirrored = T_file_part.linear().determinant() < 0.0;
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back({first + a, first + (mirrored ? c : b), first + (mirrored ? b : c)});
  for (const Eigen::Vector3f& vertex : part.vertices)
    mesh.vertices.push_back((T_file_part * vertex.cast<double>()).cast<float>());
}

namespace {

using mesh_formats::FormatError;

constexpr float farthest_vertex = 1e6F;  // see load_mesh

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return extension;
}

void check_is_mesh(const std::string& bytes) {
  if (bytes.empty()) throw FormatError("it is empty; export or copy it again");
  if (bytes.starts_with("version https://git-lfs"))
    throw FormatError("it is a Git LFS pointer, not the mesh; run 'git lfs pull' in its folder");
}

TriangleMesh read(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  const std::string bytes = read_whole_file(file, FileLimit::data);
  check_is_mesh(bytes);
  if (extension == "stl") return mesh_formats::read_stl(bytes);
  if (extension == "dae") return mesh_formats::read_collada(bytes);
  if (extension == "obj") return mesh_formats::read_obj(bytes);
  if (extension == "ply") return mesh_formats::read_ply(bytes);
  if (extension == "gltf" || extension == "glb")
    return mesh_formats::read_gltf(file, bytes, extension == "glb");
  throw FormatError("'" + extension +
                    "' is no known mesh format; use stl, dae, obj, ply, gltf or glb");
}

void check_vertices(const TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Eigen::Vector3f& p = mesh.vertices[corner];
      if (p.array().abs().maxCoeff<Eigen::PropagateNaN>() <= farthest_vertex) continue;
      const std::string place = "vertex (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) +
                                ", " + std::to_string(p.z()) + ")";
      throw FormatError(p.allFinite() ? place + " lies beyond 1e6; check the file's unit"
                                      : place + " is not finite; export the file again");
    }
  }
}

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& file) {
  try {
    const TriangleMesh read_mesh = read(file);
    if (read_mesh.triangles.empty())
      throw FormatError("it contains no triangles; export the mesh's surface");
    check_vertices(read_mesh);
    TriangleMesh mesh = weld(read_mesh);
    if (mesh.triangles.empty())
      throw FormatError("all of its triangles have zero area; check the file's unit and precision");
    return mesh;
  } catch (const FormatError& error) {
    throw InputError("mesh " + file.string() + ": " + error.what());
  } catch (const std::bad_alloc&) {
    throw InputError("mesh " + file.string() + ": too large for the memory; simplify it");
  }
}

}  // namespace penumbra
