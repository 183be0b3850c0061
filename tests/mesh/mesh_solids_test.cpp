// SPDX-License-Identifier: Apache-2.0
#include "../support/shapes.hpp"
#include "mesh_oracle.hpp"

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radii[] = {1e-6, 1e-4, 0.001, 0.02, 0.05, 0.3, 2.0};

using Distance = std::function<double(const Vector3d&)>;

double capsule_distance(const Vector3d& p, double radius, double length) {
  const double z = std::max(0.0, std::abs(p.z()) - length / 2.0);
  return std::hypot(p.x(), p.y(), z) - radius;
}

double cylinder_distance(const Vector3d& p, double radius, double length) {
  const double side = std::hypot(p.x(), p.y()) - radius;
  const double end = std::abs(p.z()) - length / 2.0;
  if (side > 0.0 && end > 0.0) return std::hypot(side, end);
  return std::max(side, end);
}

/// Largest |distance| to the true surface over corners and a grid of points on each triangle.
double surface_error(const TriangleMesh& mesh, const Distance& distance) {
  constexpr int steps = 6;
  double worst = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners(mesh, t);
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j)
        worst = std::max(worst, std::abs(distance(a + (b - a) * i / steps + (c - a) * j / steps)));
  }
  return worst;
}

void expect_solid(const TriangleMesh& mesh, double volume, double area, const Distance& distance) {
  const double rounding = 1e-6 * std::cbrt(volume);
  EXPECT_LE(surface_error(mesh, distance), primitive_error + rounding);
  const PreparedMesh prepared(mesh);
  EXPECT_EQ(prepared.vertices.size(), mesh.vertices.size()) << "vertices shared already";
  EXPECT_EQ(prepared.triangles.size(), mesh.triangles.size()) << "no degenerate triangle";
  EXPECT_EQ(prepared.patches.size(), 1U);
  EXPECT_TRUE(prepared.watertight);
  EXPECT_GT(signed_volume(mesh), 0.0);
  EXPECT_NEAR(signed_volume(mesh), volume, area * primitive_error + 1e-6 * volume);
}

TEST(MeshPrimitives, Box) {
  const Vector3d size(0.3, 0.02, 1.5);
  const TriangleMesh box = make_box(size);
  EXPECT_EQ(box.triangles.size(), 12U);
  expect_solid(box, size.prod(), 0.0,
               [&](const Vector3d& p) { return (p.cwiseAbs() - size / 2.0).maxCoeff(); });
}

TEST(MeshPrimitives, RoundOnes) {
  for (const double r : radii) {
    SCOPED_TRACE(r);
    expect_solid(make_sphere(r), 4.0 / 3.0 * pi * r * r * r, 4.0 * pi * r * r,
                 [=](const Vector3d& p) { return capsule_distance(p, r, 0.0); });
    expect_solid(make_cylinder(r, 0.4), pi * r * r * 0.4, 2.0 * pi * r * 0.4,
                 [=](const Vector3d& p) { return cylinder_distance(p, r, 0.4); });
    for (const double length : {0.0, 0.001, 0.4})
      expect_solid(make_capsule(r, length), pi * r * r * (4.0 / 3.0 * r + length),
                   2.0 * pi * r * (2.0 * r + length),
                   [=](const Vector3d& p) { return capsule_distance(p, r, length); });
  }
}

using Triangle = std::array<std::uint32_t, 3>;

const TriangleMesh unit_cube = box({0.5F, 0.5F, 0.5F});

TEST(Weld, DegenerateTrianglesAndUnusedVerticesGo) {
  TriangleMesh cube = unit_cube;
  cube.vertices.emplace_back(9, 9, 9);
  cube.vertices.push_back(cube.vertices[0]);
  cube.vertices.emplace_back(0.0F, 0.0F, -0.5F);  // between 1 and 2
  cube.triangles.push_back({0, 0, 1});
  cube.triangles.push_back({0, 9, 1});
  cube.triangles.push_back({1, 10, 2});
  const TriangleMesh welded = weld(cube);
  EXPECT_EQ(welded.triangles.size(), 12U);
  EXPECT_TRUE(PreparedMesh(welded).watertight);
}

TEST(Weld, TrianglesWithoutAreaGoWithoutOpeningTheirPiece) {
  // The cube's edge 0-1 is cut at one and at two points, on one of its sides only; slivers close
  // it.
  for (const bool two : {false, true}) {
    TriangleMesh cube = unit_cube;
    cube.vertices.emplace_back(-0.25F, -0.5F, -0.5F);
    cube.vertices.emplace_back(0.25F, -0.5F, -0.5F);
    ASSERT_EQ(cube.triangles[4], (Triangle{0, 1, 5}));
    const auto more = two ? std::vector<Triangle>{{8, 9, 5}, {9, 1, 5}, {0, 1, 9}, {0, 9, 8}}
                          : std::vector<Triangle>{{8, 1, 5}, {0, 1, 8}};
    cube.triangles[4] = {0, 8, 5};
    cube.triangles.insert(cube.triangles.end(), more.begin(), more.end());
    const TriangleMesh welded = weld(cube);
    EXPECT_EQ(welded.triangles.size(), two ? 16U : 14U);
    EXPECT_EQ(PreparedMesh(welded).patches.size(), 1U);
    EXPECT_TRUE(PreparedMesh(welded).watertight);
    EXPECT_DOUBLE_EQ(signed_volume(welded), 1.0);
  }
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
    TriangleMesh mesh = torus(48, 32, 0.3, 0.1);
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
    TriangleMesh apart = unit_cube;
    for (auto& vertex : apart.vertices) vertex.array() += 20.0F;
    if (trial % 4 == 0) append(mesh, apart);
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
