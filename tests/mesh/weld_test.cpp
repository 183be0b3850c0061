// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <tests/mesh/signed_volume.hpp>
#include <tests/support/random.hpp>
#include <tests/support/shapes.hpp>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

TriangleMesh unit_cube(const Eigen::Vector3f& corner = Eigen::Vector3f::Zero()) {
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices.emplace_back(corner +
                               Eigen::Vector3f(float(i & 1), float(i >> 1 & 1), float(i >> 2)));
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
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

using test::append;
using test::torus;

bool is_watertight(const TriangleMesh& mesh) { return PreparedMesh(mesh).watertight; }

/// Slow and plain twin of PreparedMesh::patches: floods over a map of edges.
std::vector<std::pair<std::vector<std::uint32_t>, bool>> flood(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, bool>>>
      edges;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = mesh.triangles[i][k];
      const auto to = mesh.triangles[i][(k + 1) % 3];
      edges[std::minmax(from, to)].emplace_back(i, from < to);
    }
  std::vector<std::set<std::uint32_t>> neighbours(mesh.triangles.size());
  std::vector<bool> open(mesh.triangles.size());
  for (const auto& [edge, uses] : edges)
    for (const auto& [a, forward] : uses) {
      const bool regular = uses.size() == 2 && uses[0].second != uses[1].second;
      if (!regular) open[a] = true;
      for (const auto& [b, ignored] : uses)
        if (regular) neighbours[a].insert(b);
    }
  std::vector<std::pair<std::vector<std::uint32_t>, bool>> result;
  std::vector<bool> seen(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (seen[i]) continue;
    std::vector<std::uint32_t> members, todo{i};
    seen[i] = true;
    while (!todo.empty()) {
      members.push_back(todo.back());
      todo.pop_back();
      for (const std::uint32_t n : neighbours[members.back()])
        if (!seen[n]) seen[n] = true, todo.push_back(n);
    }
    std::sort(members.begin(), members.end());
    const bool closed =
        std::none_of(members.begin(), members.end(), [&](auto m) { return open[m]; });
    result.emplace_back(members, closed);
  }
  return result;
}

TEST(Weld, CubeFromSoupIsOneClosedPieceOfUnitVolume) {
  const TriangleMesh welded = weld(soup_of(unit_cube({3, -2, 7})));
  EXPECT_EQ(welded.vertices.size(), 8U);
  EXPECT_DOUBLE_EQ(test::signed_volume(welded), 1.0);
  EXPECT_EQ(PreparedMesh(welded).patches.size(), 1U);
  EXPECT_TRUE(is_watertight(welded));
}

TEST(Weld, MinusZeroEqualsZero) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},     {1, 0, 0}, {0, 1, 0}, {-0.0F, -0.0F, -0.0F},
                   {1, -0.0F, 0}, {0, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}};
  const TriangleMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertices.size(), 4U);
  EXPECT_EQ(PreparedMesh(welded).patches.size(), 1U);
}

TEST(Weld, NeighbouringFloatsStayApart) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {std::nextafter(1.0F, 2.0F), 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  EXPECT_EQ(weld(mesh).vertices.size(), 4U);
}

TEST(Weld, DegenerateTrianglesAndUnusedVerticesGo) {
  TriangleMesh cube = unit_cube();
  cube.vertices.emplace_back(9, 9, 9);
  cube.vertices.push_back(cube.vertices[0]);
  cube.vertices.emplace_back(0.5F, 0.5F, 0.0F);
  cube.triangles.push_back({0, 0, 1});
  cube.triangles.push_back({0, 9, 1});
  cube.triangles.push_back({0, 10, 3});
  const TriangleMesh welded = weld(cube);
  EXPECT_EQ(welded.triangles.size(), 12U);
  EXPECT_TRUE(is_watertight(welded));
}

TEST(Weld, TrianglesWithoutAreaGoWithoutOpeningTheirPiece) {
  // The cube's edge 0-1 is cut at one and at two points, on one of its sides only; slivers close
  // it.
  for (const bool two : {false, true}) {
    TriangleMesh cube = unit_cube();
    cube.vertices.emplace_back(0.25F, 0.0F, 0.0F);
    cube.vertices.emplace_back(0.75F, 0.0F, 0.0F);
    ASSERT_EQ(cube.triangles[4], (Triangle{0, 1, 4}));
    if (two) {
      cube.triangles[4] = {0, 8, 4};
      cube.triangles.insert(cube.triangles.end(), {{8, 9, 4}, {9, 1, 4}, {0, 1, 9}, {0, 9, 8}});
    } else {
      cube.triangles[4] = {0, 8, 4};
      cube.triangles.insert(cube.triangles.end(), {{8, 1, 4}, {0, 1, 8}});
    }
    const TriangleMesh welded = weld(cube);
    EXPECT_EQ(welded.triangles.size(), two ? 16U : 14U);
    EXPECT_EQ(PreparedMesh(welded).patches.size(), 1U);
    EXPECT_TRUE(is_watertight(welded));
    EXPECT_DOUBLE_EQ(test::signed_volume(welded), 1.0);
  }
}

TEST(Weld, AgreesWithAFloodOnRandomSoups) {
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
    if (trial % 4 == 0) append(mesh, unit_cube({20, 20, 20}));
    const PreparedMesh prepared(mesh);
    const auto expected = flood(prepared);
    ASSERT_EQ(prepared.patches.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(prepared.patches[i].triangles, expected[i].first);
      EXPECT_EQ(prepared.patches[i].closed, expected[i].second);
    }
  }
}

}  // namespace
}  // namespace penumbra
