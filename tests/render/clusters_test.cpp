// SPDX-License-Identifier: Apache-2.0
// Meshes that share what sound ones do not: the time still grows with the triangles alone.
#include <chrono>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <penumbra/render/clusters.hpp>

namespace penumbra {
namespace {

constexpr std::uint32_t triangle_count = 80'000;
constexpr double hang = 15.0;  // seconds; of about one, and once 20 to 60

void expect_quick(const TriangleMesh& mesh) {
  const auto start = std::chrono::steady_clock::now();
  const PreparedMesh prepared(mesh);
  const Body body{"odd", {&prepared, 1}};
  const ClusteredScene scene({&body, 1});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), hang);
  std::size_t triangles = 0;
  for (const Cluster& cluster : scene.clusters) triangles += cluster.triangle_count;
  EXPECT_EQ(triangles, mesh.triangles.size());
}

TEST(Clusters, OfCopiesOfOneTriangle) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
  mesh.triangles.assign(triangle_count, {0, 1, 2});
  expect_quick(mesh);
}

TEST(Clusters, OfTrianglesThatShareOneEdge) {
  TriangleMesh mesh{{{0, 0, 0}, {0, 0, 1}}, {}};
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const double angle = 6.28 * i / triangle_count;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.5);
    mesh.triangles.push_back({0, 1, i + 2});
  }
  expect_quick(mesh);
}

TEST(Clusters, OfSeparateTrianglesAroundOnePoint) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const float s = static_cast<float>(i + 1) / 65536.0F;
    mesh.vertices.insert(mesh.vertices.end(), {{-s, -s, 0}, {2 * s, -s, 0}, {-s, 2 * s, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  expect_quick(mesh);
}

TEST(Clusters, AreSharedByCopiesOfAMesh) {
  const TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const PreparedMesh mesh(triangle), copy = mesh, other(triangle);
  const auto scene_of = [](const PreparedMesh& one) {
    const Body body{"triangle", {&one, 1}};
    return shared_scene({&body, 1});
  };
  const auto scene = scene_of(mesh);
  EXPECT_EQ(scene, scene_of(copy));
  EXPECT_NE(scene, scene_of(other));
}

}  // namespace
}  // namespace penumbra
