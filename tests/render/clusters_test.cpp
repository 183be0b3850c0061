// SPDX-License-Identifier: Apache-2.0
// Meshes that share what sound ones do not: the time still grows with the triangles alone.
#include "../support/test.hpp"

#include <ctime>

#include <penumbra/render/clusters.hpp>

namespace penumbra::test {
namespace {

/// CPU seconds to build the scene of a mesh, whose triangles must all be in it.
double build(const TriangleMesh& mesh) {
  const std::clock_t start = std::clock();
  const PreparedMesh prepared(mesh);
  const Body body{"odd", {&prepared, 1}};
  const ClusteredScene scene({&body, 1});
  const std::clock_t end = std::clock();
  std::size_t triangles = 0;
  for (const Cluster& cluster : scene.clusters) triangles += cluster.triangle_count;
  EXPECT_EQ(triangles, mesh.triangles.size());
  return double(end - start) / CLOCKS_PER_SEC;
}

/// Four times as many triangles take about four times as long; with the square it were 16 times.
void expect_linear(const std::function<TriangleMesh(std::uint32_t)>& mesh_of) {
  constexpr std::uint32_t count = 80'000;
  constexpr double most = 10.0, rounding = 0.1;  // seconds: less than that is not compared
  const double quarter = std::min(build(mesh_of(count / 4)), build(mesh_of(count / 4)));
  EXPECT_LT(build(mesh_of(count)), most * std::max(quarter, rounding));
}

TEST(Clusters, OfCopiesOfOneTriangle) {
  expect_linear([](std::uint32_t count) {
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
    mesh.triangles.assign(count, {0, 1, 2});
    return mesh;
  });
}

TEST(Clusters, OfTrianglesThatShareOneEdge) {
  expect_linear([](std::uint32_t count) {
    TriangleMesh mesh{{{0, 0, 0}, {0, 0, 1}}, {}};
    for (std::uint32_t i = 0; i < count; ++i) {
      const double angle = 6.28 * i / count;
      mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.5);
      mesh.triangles.push_back({0, 1, i + 2});
    }
    return mesh;
  });
}

TEST(Clusters, OfSeparateTrianglesAroundOnePoint) {
  expect_linear([](std::uint32_t count) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float s = float(i + 1) / 65536.0F;
      mesh.vertices.insert(mesh.vertices.end(), {{-s, -s, 0}, {2 * s, -s, 0}, {-s, 2 * s, 0}});
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
  });
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
}  // namespace penumbra::test
