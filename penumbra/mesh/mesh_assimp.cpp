// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <penumbra/mesh/mesh_formats-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4>;

Eigen::Matrix4d matrix_of(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

/// What Assimp's steps and ours take for granted.
void check_faces(const aiMesh& part) {
  if (part.mNumFaces > 0 && (part.mNumVertices == 0 || part.mVertices == nullptr))
    throw FormatError("mesh '" + std::string(part.mName.C_Str()).substr(0, 80) +
                      "' has faces and no vertices; export the file again");
  for (const aiFace& face : std::span(part.mFaces, part.mNumFaces))
    for (const unsigned corner : std::span(face.mIndices, face.mNumIndices))
      if (corner >= part.mNumVertices)
        throw FormatError("a face names vertex " + std::to_string(corner) + " of " +
                          std::to_string(part.mNumVertices) + "; export the file again");
}

void append_faces(const aiMesh& part, bool mirrored, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines have no surface
    std::array<std::uint32_t, 3> t{};
    for (unsigned k = 0; k < 3; ++k) t[k] = first + face.mIndices[k];
    if (mirrored) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  if (mesh.triangles.size() > most_triangles)
    throw FormatError("more than " + std::to_string(most_triangles) +
                      " triangles; export a simplified mesh");
}

void append(const aiMesh& part, const Eigen::Matrix4d& T_file_node, TriangleMesh& mesh) {
  if (part.mNumFaces == 0) return;
  append_faces(part, T_file_node.topLeftCorner<3, 3>().determinant() < 0.0, mesh);
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Eigen::Vector4d p = T_file_node * Eigen::Vector4d(v.x, v.y, v.z, 1.0);
    mesh.vertices.push_back(p.head<3>().cast<float>());
  }
}

TriangleMesh flatten(const aiScene& scene) {
  struct Visit {
    const aiNode* node;
    Eigen::Matrix4d T_file_parent;
  };
  TriangleMesh mesh;
  std::vector<Visit> todo{{scene.mRootNode, Eigen::Matrix4d::Identity()}};
  while (!todo.empty()) {
    const auto [node, T_file_parent] = todo.back();
    todo.pop_back();
    const Eigen::Matrix4d T_file_node = T_file_parent * matrix_of(node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      append(*scene.mMeshes[node->mMeshes[i]], T_file_node, mesh);
    for (unsigned i = node->mNumChildren; i-- > 0;)
      todo.push_back({node->mChildren[i], T_file_node});
  }
  return mesh;
}

/// Triangles of all parts, which are checked.
std::size_t count_triangles(const aiScene& scene) {
  std::size_t count = 0;
  for (const aiMesh* const part : std::span(scene.mMeshes, scene.mNumMeshes)) {
    check_faces(*part);
    for (const aiFace& face : std::span(part->mFaces, part->mNumFaces))
      count += face.mNumIndices == 3 ? 1 : 0;
  }
  return count;
}

}  // namespace

Scene read_with_assimp(const std::filesystem::path& file, std::string_view bytes, bool binary) {
  Assimp::Importer importer;
  // No post-processing: our weld joins vertices faster, and nothing else of it is needed.
  const aiScene* const scene =
      binary ? importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "glb")
             : importer.ReadFile(file.string(), 0);
  if (scene == nullptr)
    throw FormatError(std::string(importer.GetErrorString()).substr(0, 300) +
                      "; export the file again");
  if (scene->mRootNode == nullptr) throw FormatError("it holds no scene; export the file again");
  const std::size_t stored = count_triangles(*scene);
  return {flatten(*scene), stored};
}

}  // namespace penumbra::mesh_formats
