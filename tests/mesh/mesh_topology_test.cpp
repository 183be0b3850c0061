// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <tests/support/random.hpp>
#include <tests/support/shapes.hpp>

#include <penumbra/mesh/mesh_topology.hpp>

namespace penumbra {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// From (low, low, low), a metre along each axis.
TriangleMesh unit_cube(float low = 0.0F) {
  TriangleMesh cube = test::box({0.5F, 0.5F, 0.5F});
  for (auto& v : cube.vertices) v += Eigen::Vector3f::Constant(low + 0.5F);
  return cube;
}

TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t corner : t) soup.vertices.push_back(mesh.vertices[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// Slow and plain twin of connected_components: floods over a map of edges.
std::vector<std::pair<std::vector<std::size_t>, bool>> flood(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::size_t, bool>>>
      edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = mesh.triangles[i][k];
      const auto to = mesh.triangles[i][(k + 1) % 3];
      edges[std::minmax(from, to)].emplace_back(i, from < to);
    }
  std::vector<std::set<std::size_t>> neighbours(mesh.triangles.size());
  std::vector<bool> open(mesh.triangles.size());
  for (const auto& [edge, uses] : edges)
    for (const auto& [a, forward] : uses) {
      if (uses.size() != 2 || uses[0].second == uses[1].second) open[a] = true;
      for (const auto& [b, ignored] : uses) neighbours[a].insert(b);
    }
  std::vector<std::pair<std::vector<std::size_t>, bool>> result;
  std::vector<bool> seen(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (seen[i]) continue;
    std::vector<std::size_t> members, todo{i};
    seen[i] = true;
    while (!todo.empty()) {
      members.push_back(todo.back());
      todo.pop_back();
      for (const std::size_t n : neighbours[members.back()])
        if (!seen[n]) seen[n] = true, todo.push_back(n);
    }
    std::sort(members.begin(), members.end());
    const bool closed =
        std::none_of(members.begin(), members.end(), [&](auto m) { return open[m]; });
    result.emplace_back(members, closed);
  }
  return result;
}

TEST(MeshTopology, MinusZeroEqualsZero) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},     {1, 0, 0}, {0, 1, 0}, {-0.0F, -0.0F, -0.0F},
                   {1, -0.0F, 0}, {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  const TriangleMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertices.size(), 4U);
  EXPECT_EQ(connected_components(welded).size(), 1U);
}

TEST(MeshTopology, NeighbouringFloatsStayApart) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {std::nextafter(1.0F, 2.0F), 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  EXPECT_EQ(weld(mesh).vertices.size(), 4U);
}

TEST(MeshTopology, DegenerateTrianglesAndUnusedVerticesGo) {
  TriangleMesh cube = unit_cube();
  cube.vertices.emplace_back(9, 9, 9);
  cube.vertices.push_back(cube.vertices[0]);
  cube.vertices.emplace_back(0.5F, 0.5F, 0.0F);
  cube.triangles.push_back({0, 0, 1});
  cube.triangles.push_back({0, 9, 1});
  cube.triangles.push_back({1, 10, 2});
  const TriangleMesh welded = weld(cube);
  EXPECT_EQ(welded.triangles.size(), 12U);
  EXPECT_TRUE(is_watertight(welded));
}

TEST(MeshTopology, TrianglesWithoutAreaGoWithoutOpeningTheirPiece) {
  // The cube's edge 0-1 is cut at one and at two points, on one of its sides only; slivers close
  // it.
  for (const bool two : {false, true}) {
    TriangleMesh cube = unit_cube();
    cube.vertices.emplace_back(0.25F, 0.0F, 0.0F);
    cube.vertices.emplace_back(0.75F, 0.0F, 0.0F);
    ASSERT_EQ(cube.triangles[4], (Triangle{0, 1, 5}));
    if (two) {
      cube.triangles[4] = {0, 8, 5};
      cube.triangles.insert(cube.triangles.end(), {{8, 9, 5}, {9, 1, 5}, {0, 1, 9}, {0, 9, 8}});
    } else {
      cube.triangles[4] = {0, 8, 5};
      cube.triangles.insert(cube.triangles.end(), {{8, 1, 5}, {0, 1, 8}});
    }
    ASSERT_TRUE(connected_components(cube)[0].closed);
    const TriangleMesh welded = weld(cube);
    EXPECT_EQ(welded.triangles.size(), two ? 16U : 14U);
    const auto pieces = connected_components(welded);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_TRUE(pieces[0].closed);
    EXPECT_DOUBLE_EQ(pieces[0].signed_volume, 1.0);
  }
}

TEST(MeshTopology, TorusVolumeIsTheClosedForm) {
  constexpr double ring = 0.3;
  constexpr double tube = 0.1;
  const auto pieces = connected_components(weld(soup_of(test::torus(200, 100, ring, tube))));
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_TRUE(pieces[0].closed);
  const double exact = 2 * std::numbers::pi * std::numbers::pi * ring * tube * tube;
  constexpr double chord_loss = 2e-3;  // 1 - sinc(2 pi / 100) of the tube, and less of the ring
  EXPECT_NEAR(pieces[0].signed_volume / exact, 1.0, chord_loss);
}

TEST(MeshTopology, AgreesWithAFloodOnRandomSoups) {
  auto random = test::seeded_random(20);
  for (int trial = 0; trial < 200; ++trial) {
    const auto vertices = static_cast<std::uint32_t>(4 + random() % 30);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < vertices; ++i)
      mesh.vertices.emplace_back(float(random() % 9), float(random() % 9), float(random() % 9));
    const std::size_t triangles = 1 + random() % 60;
    for (std::size_t i = 0; i < triangles; ++i)
      mesh.triangles.push_back({static_cast<std::uint32_t>(random() % vertices),
                                static_cast<std::uint32_t>(random() % vertices),
                                static_cast<std::uint32_t>(random() % vertices)});
    if (trial % 4 == 0) test::append(mesh, unit_cube(20.0F));
    const TriangleMesh welded = weld(mesh);
    const auto expected = flood(welded);
    const auto actual = connected_components(welded);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
      EXPECT_EQ(actual[i].triangles, expected[i].first);
      EXPECT_EQ(actual[i].closed, expected[i].second);
    }
  }
}

TEST(MeshTopology, TwoMillionTrianglesTakeSeconds) {
  const TriangleMesh soup = soup_of(test::torus(1000, 1000, 0.3, 0.1));
  const auto start = std::chrono::steady_clock::now();
  const TriangleMesh welded = weld(soup);
  const auto pieces = connected_components(welded);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::cout << soup.triangles.size() << " triangles: " << took.count() << " s\n";
  EXPECT_EQ(welded.vertices.size(), 1000000U);
  EXPECT_EQ(pieces.size(), 1U);
  EXPECT_TRUE(pieces[0].closed);
  constexpr double hang = 60.0;  // tells linear from quadratic time, not fast from slow machines
  EXPECT_LT(took.count(), hang);
}

}  // namespace
}  // namespace penumbra
