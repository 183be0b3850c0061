// SPDX-License-Identifier: Apache-2.0
#include "../support/shapes.hpp"
#include "../support/test.hpp"
#include "mesh_oracle.hpp"

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra::test {
namespace {

TriangleMesh ring(std::uint32_t rows, std::uint32_t columns) {
  return torus(rows, columns, 0.3, 0.1);
}

TEST(PreparedMesh, ClosedPatchesFaceOneWayAndHaveNoHoles) {
  TriangleMesh mesh = ring(12, 8);
  append(mesh, mirrored(ring(10, 7)));
  const PreparedMesh prepared(mesh);
  ASSERT_EQ(prepared.patches.size(), 2U);
  EXPECT_EQ(prepared.patches[0].triangles.size(), 2U * 12 * 8);
  EXPECT_TRUE(prepared.watertight);
  EXPECT_EQ(prepared.orientations()[0].facing, Facing::outwards);
  EXPECT_EQ(prepared.orientations()[1].facing, Facing::inwards);
  EXPECT_TRUE(prepared.orientations()[0].holes.empty());
}

/// The triangles of one patch.
TriangleMesh mesh_of(const PreparedMesh& mesh, const SurfacePatch& patch) {
  TriangleMesh part{mesh.vertices, {}};
  for (const std::uint32_t i : patch.triangles) part.triangles.push_back(mesh.triangles[i]);
  return part;
}

TEST(PreparedMesh, RaysFromOutsideMeetOuterSidesFirstOrGoThroughHoles) {
  std::mt19937_64 random = seeded_random(311);
  std::uniform_real_distribution<double> near(-0.4, 0.4);
  int known = 0, backs = 0;
  for (int round = 0; round < samples(40); ++round) {
    TriangleMesh mesh = ring(48, 32);
    for (int i = 0; i < 1 + round % 6; ++i) {
      const auto victim = std::ptrdiff_t(random() % mesh.triangles.size());
      auto& t = mesh.triangles[std::size_t(victim)];
      if (random() % 3 == 0) std::swap(t[0], t[1]);
      if (random() % 2 == 0) mesh.triangles.erase(mesh.triangles.begin() + victim);
    }
    const PreparedMesh prepared(mesh);
    for (std::size_t number = 0; number < prepared.patches.size(); ++number) {
      const auto& [facing, holes] = prepared.orientations()[number];
      if (facing == Facing::unknown) continue;
      ++known;
      const TriangleMesh patch = mesh_of(prepared, prepared.patches[number]);
      for (int i = 0; i < 200; ++i) {
        // Half of the rays aim at a hole, where backs are to be seen.
        Vector3d aim(near(random), near(random), 0.3 * near(random));
        if (i % 2 == 0 && !holes.empty()) {
          const Ball& hole = holes[random() % holes.size()];
          aim = hole.centre + hole.radius * aim;
        }
        const Vector3d origin = 2.0 * random_direction(random);
        const Vector3d ray = aim - origin;
        const auto met = crossings(patch, origin, ray);
        const auto first = std::ranges::min_element(met, {}, &Crossing::t);
        if (first == met.end() || first->leaves == (facing == Facing::inwards)) continue;
        ++backs;
        EXPECT_TRUE(std::any_of(holes.begin(), holes.end(), [&](const Ball& hole) {
          return (hole.centre - origin).cross(ray).norm() <= hole.radius * ray.norm();
        }));
      }
    }
  }
  EXPECT_GT(known, samples(20));
  EXPECT_GT(backs, samples(100));
}

using Triangle = std::array<std::uint32_t, 3>;

TriangleMesh unit_cube(const Vector3f& corner = Vector3f::Zero()) {
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices.emplace_back(corner + Vector3f(float(i & 1), float(i >> 1 & 1), float(i >> 2)));
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return cube;
}

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

TEST(Weld, EqualCornersAreOne) {
  for (const float x : {1.0F, std::nextafter(1.0F, 2.0F)}) {
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, -0.0F, -0.0F}, {x, -0.0F, 0}},
                      {{0, 1, 2}, {3, 2, 4}}};
    EXPECT_EQ(weld(mesh).vertices.size(), x == 1.0F ? 3U : 4U);
  }
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
  EXPECT_TRUE(PreparedMesh(welded).watertight);
}

TEST(Weld, TrianglesWithoutAreaGoWithoutOpeningTheirPiece) {
  // The cube's edge 0-1 is cut at one and at two points, on one of its sides only; slivers close
  // it.
  for (const bool two : {false, true}) {
    TriangleMesh cube = unit_cube();
    cube.vertices.emplace_back(0.25F, 0.0F, 0.0F);
    cube.vertices.emplace_back(0.75F, 0.0F, 0.0F);
    ASSERT_EQ(cube.triangles[4], (Triangle{0, 1, 4}));
    const auto more = two ? std::vector<Triangle>{{8, 9, 4}, {9, 1, 4}, {0, 1, 9}, {0, 9, 8}}
                          : std::vector<Triangle>{{8, 1, 4}, {0, 1, 8}};
    cube.triangles[4] = {0, 8, 4};
    cube.triangles.insert(cube.triangles.end(), more.begin(), more.end());
    const TriangleMesh welded = weld(cube);
    EXPECT_EQ(welded.triangles.size(), two ? 16U : 14U);
    EXPECT_EQ(PreparedMesh(welded).patches.size(), 1U);
    EXPECT_TRUE(PreparedMesh(welded).watertight);
    EXPECT_DOUBLE_EQ(signed_volume(welded), 1.0);
  }
}

TEST(Weld, AgreesWithAFloodOnRandomSoups) {
  auto random = seeded_random(20);
  for (int trial = 0; trial < 200; ++trial) {
    const auto vertices = std::uint32_t(4 + random() % 30);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < vertices; ++i)
      mesh.vertices.emplace_back(float(random() % 9), float(random() % 9), float(random() % 9));
    const std::size_t triangles = 1 + random() % 60;
    for (std::size_t i = 0; i < triangles; ++i)
      mesh.triangles.push_back({std::uint32_t(random() % vertices),
                                std::uint32_t(random() % vertices),
                                std::uint32_t(random() % vertices)});
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
}  // namespace penumbra::test
