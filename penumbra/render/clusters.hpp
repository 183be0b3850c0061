// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {

/// A handful of neighbouring triangles with their own vertex list.
struct Cluster {
  std::uint32_t first_vertex;    ///< into ClusteredScene's vertex arrays; padded
  std::uint32_t vertex_count;    ///< without padding
  std::uint32_t first_triangle;  ///< into ClusteredScene's triangle arrays; padded
  std::uint32_t triangle_count;  ///< without padding
};

/// Clusters that share one answer to "may back faces be skipped?".
struct ClusterGroup {
  std::uint32_t body = 0;
  /// Bounds bodies and is wound outwards: from outside, back faces are only seen through the holes.
  bool solid = false;
  std::uint32_t first_hole = 0;  ///< into ClusteredScene::holes
  std::uint32_t hole_count = 0;
  std::uint32_t first_cluster = 0;
  std::uint32_t cluster_count = 0;
  Eigen::AlignedBox3d bounds{};  ///< in the body's frame
};

/// All bodies' triangles made ready for a renderer: merged vertices, faces wound outwards where a
/// piece of mesh bounds a body, small clusters, planes. Every array is padded so that vectors of up
/// to `padding` lanes may be loaded from any cluster's start to its end.
struct ClusteredScene {
  static constexpr std::uint32_t padding = 16;
  static constexpr std::uint32_t max_vertices = 96;
  static constexpr std::uint32_t max_triangles = 128;

  explicit ClusteredScene(std::span<const Body> bodies);

  std::vector<ClusterGroup> groups;  ///< by body
  std::vector<Cluster> clusters;
  std::vector<Ball> holes;  ///< in the bodies' frames

  /// Bounding spheres of the clusters, in the body's frame; padded with spheres of radius 0.
  std::vector<float> sphere_x, sphere_y, sphere_z, sphere_radius;

  /// Sums of the clusters' normals by area; padded.
  std::vector<float> normal_x, normal_y, normal_z;

  std::vector<float> x, y, z;  ///< vertices in the body's frame, padded by repeating the last

  /// Outward planes n . p = d with |n| = 1, computed in double; padded with zeros.
  std::vector<float> plane_x, plane_y, plane_z, plane_d;

  /// Corners as indices into the cluster's vertices: first + 256 * second + 65536 * third.
  std::vector<std::uint32_t> corners;

 private:
  void add_group(const TriangleMesh& mesh, const std::vector<std::uint32_t>& indices,
                 ClusterGroup group);
  /// Returns its normal, twice as long as its area.
  Eigen::Vector3d add_triangle(const TriangleMesh& mesh, const std::uint32_t* cluster_vertices,
                               const unsigned char* local);
  void pad_vertices();
  void pad_triangles();
};

/// Returns the scene of some bodies. Renderers of copies of the same meshes share it, in whichever
/// thread they are made; others wait while it is built.
[[nodiscard]] std::shared_ptr<const ClusteredScene> shared_scene(std::span<const Body> bodies);

}  // namespace penumbra
