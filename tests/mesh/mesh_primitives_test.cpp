// SPDX-License-Identifier: Apache-2.0
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

TriangleMesh unit_cube() {
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices.emplace_back(float(i & 1), float(i >> 1 & 1), float(i >> 2));
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return cube;
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

}  // namespace
}  // namespace penumbra::test
