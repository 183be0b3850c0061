// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

#include <meshoptimizer.h>

#include <penumbra/mesh/surface_patches.hpp>
#include <penumbra/render/clusters.hpp>
#include <penumbra/render/triangle_groups.hpp>

namespace penumbra {
namespace {

/// Whether meshopt_buildMeshlets takes time in proportion to the triangles: it looks through all
/// triangles of a vertex for each of them, and through all triangles for each separate piece.
bool has_neighbourhoods(const TriangleMesh& mesh, const std::vector<std::uint32_t>& indices) {
  constexpr std::size_t most = 1000;  // looks for each triangle; separate pieces
  std::vector<std::size_t> uses(mesh.vertices.size(), 0);
  DisjointSets pieces(mesh.vertices.size());
  std::size_t joined = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    ++uses[indices[i]];
    joined += pieces.join(indices[i - i % 3], indices[i]) ? 1 : 0;
  }
  const auto used =
      uses.size() - static_cast<std::size_t>(std::count(uses.begin(), uses.end(), 0U));
  const std::size_t looks =
      std::inner_product(uses.begin(), uses.end(), uses.begin(), std::size_t{0});
  return looks <= most * indices.size() / 3 && used - joined <= most;
}

}  // namespace

ClusteredScene::ClusteredScene(std::span<const Body> bodies) {
  for (std::uint32_t body = 0; body < bodies.size(); ++body) {
    for (const PreparedMesh& mesh : bodies[body].meshes) {
      for (const TriangleGroup& group : groups_of(mesh)) {
        add_group(mesh, group.indices,
                  {.body = body,
                   .solid = group.solid,
                   .first_hole = static_cast<std::uint32_t>(holes.size()),
                   .hole_count = static_cast<std::uint32_t>(group.holes.size()),
                   .bounds = group.bounds});
        holes.insert(holes.end(), group.holes.begin(), group.holes.end());
      }
    }
  }
  const std::size_t padded = clusters.size() + padding;
  for (auto* values :
       {&sphere_x, &sphere_y, &sphere_z, &sphere_radius, &normal_x, &normal_y, &normal_z})
    values->resize(padded);
}

void ClusteredScene::add_group(const TriangleMesh& mesh, const std::vector<std::uint32_t>& indices,
                               ClusterGroup group) {
  const float* positions = mesh.vertices.front().data();
  const std::size_t bound = meshopt_buildMeshletsBound(indices.size(), max_vertices, max_triangles);
  std::vector<meshopt_Meshlet> meshlets(bound);
  std::vector<std::uint32_t> vertices(bound * max_vertices);
  std::vector<unsigned char> local(bound * max_triangles * 3);
  constexpr float cone_weight = 0.25F;  // some weight for clusters that face one way as a whole
  meshlets.resize(
      has_neighbourhoods(mesh, indices)
          ? meshopt_buildMeshlets(meshlets.data(), vertices.data(), local.data(), indices.data(),
                                  indices.size(), positions, mesh.vertices.size(),
                                  sizeof(Eigen::Vector3f), max_vertices, max_triangles, cone_weight)
          : meshopt_buildMeshletsScan(meshlets.data(), vertices.data(), local.data(),
                                      indices.data(), indices.size(), mesh.vertices.size(),
                                      max_vertices, max_triangles));
  group.first_cluster = static_cast<std::uint32_t>(clusters.size());
  group.cluster_count = static_cast<std::uint32_t>(meshlets.size());
  for (const meshopt_Meshlet& meshlet : meshlets) {
    clusters.push_back({static_cast<std::uint32_t>(x.size()), meshlet.vertex_count,
                        static_cast<std::uint32_t>(corners.size()), meshlet.triangle_count});
    const std::uint32_t* own = &vertices[meshlet.vertex_offset];
    Eigen::AlignedBox3f box;
    for (std::uint32_t i = 0; i < meshlet.vertex_count; ++i) {
      const Eigen::Vector3f& p = mesh.vertices[own[i]];
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
      box.extend(p);
    }
    float radius = 0.0F;
    for (std::uint32_t i = 0; i < meshlet.vertex_count; ++i) {
      radius = std::max(radius, (mesh.vertices[own[i]] - box.center()).norm());
    }
    sphere_x.push_back(box.center().x());
    sphere_y.push_back(box.center().y());
    sphere_z.push_back(box.center().z());
    sphere_radius.push_back(radius * 1.0001F);  // roundings of centre and radius
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (std::uint32_t t = 0; t < meshlet.triangle_count; ++t) {
      normal += add_triangle(mesh, own, &local[meshlet.triangle_offset + 3 * t]);
    }
    normal_x.push_back(static_cast<float>(normal.x()));
    normal_y.push_back(static_cast<float>(normal.y()));
    normal_z.push_back(static_cast<float>(normal.z()));
    pad_vertices();
    pad_triangles();
  }
  groups.push_back(group);
}

Eigen::Vector3d ClusteredScene::add_triangle(const TriangleMesh& mesh,
                                             const std::uint32_t* cluster_vertices,
                                             const unsigned char* local) {
  const Eigen::Vector3d a = mesh.vertices[cluster_vertices[local[0]]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[cluster_vertices[local[1]]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices[cluster_vertices[local[2]]].cast<double>();
  Eigen::Vector3d area = (b - a).cross(c - a);
  const Eigen::Vector3d n = area.normalized();
  plane_x.push_back(static_cast<float>(n.x()));
  plane_y.push_back(static_cast<float>(n.y()));
  plane_z.push_back(static_cast<float>(n.z()));
  plane_d.push_back(static_cast<float>(n.dot(a + b + c) / 3.0));
  corners.push_back(local[0] + 256U * local[1] + 65536U * local[2]);
  return area;
}

std::shared_ptr<const ClusteredScene> shared_scene(std::span<const Body> bodies) {
  using Meshes = std::vector<std::shared_ptr<const void>>;  // null after those of a body
  static std::mutex mutex;
  static std::map<Meshes, std::weak_ptr<const ClusteredScene>> scenes;
  Meshes meshes;
  for (const Body& body : bodies) {
    for (const PreparedMesh& mesh : body.meshes) meshes.push_back(mesh.identity());
    meshes.push_back(nullptr);
  }
  const std::lock_guard lock(mutex);
  std::erase_if(scenes, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<const ClusteredScene>& known = scenes[std::move(meshes)];
  std::shared_ptr<const ClusteredScene> scene = known.lock();
  if (!scene) known = scene = std::make_shared<const ClusteredScene>(bodies);
  return scene;
}

void ClusteredScene::pad_vertices() {
  for (auto* values : {&x, &y, &z}) {
    while (values->size() % padding != 0) values->push_back(values->back());
  }
}

void ClusteredScene::pad_triangles() {
  const std::size_t padded = (corners.size() + padding - 1) / padding * padding;
  for (auto* values : {&plane_x, &plane_y, &plane_z, &plane_d}) values->resize(padded, 0.0F);
  corners.resize(padded, 0);
}

}  // namespace penumbra
