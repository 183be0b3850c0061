// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include <gtest/gtest.h>
#include <tests/robot/offset_oracle.hpp>
#include <tests/robot/offset_shapes.hpp>
#include <tests/support/data.hpp>
#include <tests/support/random.hpp>
#include <tests/support/run_length.hpp>

#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/mesh_file.hpp>
#include <penumbra/robot/primitives.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using test::corner_rounding;
using test::refusal;

/// How often a mesh surrounds p: fronts left minus fronts entered, along a ray that meets no edge.
int windings(const TriangleMesh& mesh, const Vector3d& p) {
  const Vector3d ray(0.5412, 0.3127, 0.7806);
  int sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = test::corners(mesh, i);
    const double u = ray.dot((b - p).cross(c - p));
    const double v = ray.dot((c - p).cross(a - p));
    const double w = ray.dot((a - p).cross(b - p));
    const bool left = u > 0.0 && v > 0.0 && w > 0.0;
    const bool entered = u < 0.0 && v < 0.0 && w < 0.0;
    if (!left && !entered) continue;
    if ((a - p).dot((b - a).cross(c - a)) * (left ? 1.0 : -1.0) > 0.0) sum += left ? 1 : -1;
  }
  return sum;
}

struct Samples {
  int surface;
  int space;
};

/// The result's surface and its inside are those of the exact eroded solid within the bounds
/// stated.
void expect_eroded(const TriangleMesh& mesh, const TriangleMesh& eroded, double depth,
                   const Samples& samples) {
  ASSERT_TRUE(is_watertight(weld(eroded)));
  const double least = depth * (1.0 - shrink_error_outwards) - corner_rounding;
  const double most = depth * (1.0 + shrink_error_inwards) + corner_rounding;
  auto random = test::seeded_random(51);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double nearest = 2.0 * depth;
  double farthest = 0.0;
  for (int i = 0; i < test::samples(samples.surface); ++i) {
    const auto [a, b, c] = test::corners(eroded, random() % eroded.triangles.size());
    const double u = std::sqrt(share(random));
    const double v = share(random);
    const Vector3d p = (1 - u) * a + u * (1 - v) * b + u * v * c;
    const double d = test::distance(mesh, p);
    ASSERT_GE(d, least);
    ASSERT_LE(d, most);
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
    if (i % 16 != 0) continue;
    ASSERT_GT(windings(mesh, p), 0) << p.transpose();
  }
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v.cast<double>());
  int in = 0;
  int out = 0;
  for (int i = 0; i < test::samples(samples.space); ++i) {
    const Vector3d p =
        box.min() + Vector3d(share(random), share(random), share(random)).cwiseProduct(box.sizes());
    const bool inside = windings(mesh, p) > 0;
    const double d = inside ? test::distance(mesh, p) : 0.0;
    if (d > least && d < most) continue;
    ASSERT_EQ(windings(eroded, p) > 0, d >= most) << p.transpose() << ", depth " << d;
    ++(d >= most ? in : out);
  }
  std::cout << mesh.triangles.size() << " -> " << eroded.triangles.size() << " triangles, depths "
            << 1e3 * nearest << " to " << 1e3 * farthest << " mm of " << 1e3 * depth << ", " << in
            << " points inside, " << out << " outside\n";
  EXPECT_GT(in, 0);
  EXPECT_GT(out, 0);
}

/// A block with a fin: thin, pointed and vanishing.
TriangleMesh finned(double thickness) {
  return test::extrude(
      {{0, 0}, {0.08, 0}, {0.08, thickness}, {0.04, thickness}, {0.03, 0.05}, {0, 0.04}}, 0.03);
}

TEST(OffsetGrid, DetailsThatVanishLeaveTheRest) {
  constexpr double depth = 0.002;
  for (const double thickness : {0.003, 0.0055}) {
    const TriangleMesh mesh = finned(thickness);
    expect_eroded(mesh, offset_surface(mesh, -depth), depth, {1000, 500});
  }
}

TEST(OffsetGrid, ConvexAndConcaveEverywhere) {
  auto random = test::seeded_random(52);
  for (const double depth : {0.02, 0.005}) {
    const TriangleMesh mesh = test::crumpled(random, 0.4);
    expect_eroded(mesh, offset_surface(mesh, -depth), depth, {1000, 500});
    if (test::sanitized) break;  // the finer grid runs through the same code
  }
}

TEST(OffsetGrid, SurfacesInsideOtherPiecesAreWalls) {
  constexpr double depth = 0.01;
  TriangleMesh two = make_box({0.1, 0.1, 0.1});
  test::append(two, make_box({0.1, 0.08, 0.06}), {0.05, 0, 0});
  expect_eroded(two, offset_surface(two, -depth), depth, {1000, 500});
  for (auto& t : two.triangles) std::swap(t[0], t[1]);
  const TriangleMesh eroded = offset_surface(two, -depth);
  EXPECT_GT(windings(eroded, {-0.03, 0, 0}), 0);
  EXPECT_EQ(windings(eroded, {-0.045, 0, 0}), 0);
}

TEST(OffsetGrid, RefusalsSayWhatToDo) {
  EXPECT_NE(refusal(finned(0.003), -0.02).find("leaves nothing of the mesh"), std::string::npos);
  const std::string small = refusal(finned(3e-5), -2e-5);
  EXPECT_NE(small.find("would need millions of triangles; take 0 or try -"), std::string::npos)
      << small;
}

TEST(OffsetGrid, RealLinks) {
  PENUMBRA_REQUIRE_DATA();
  const auto robots = test::data_folder() / "robots";
  for (const char* file : {"ur5e/ur_description/meshes/ur5e/collision/wrist3.stl",
                           "xarm7/xarm_description/meshes/xarm7/visual/link7.STL"}) {
    const TriangleMesh mesh = load_mesh(robots / file);
    expect_eroded(mesh, offset_surface(mesh, -0.002), 0.002, {500, 200});
    if (test::sanitized) break;  // the finer mesh runs through the same code
  }
}

/// Thin walls, which the grid cuts into pieces.
TEST(OffsetGridFull, LinkOfThinWalls) {
  if (!test::measures_in_full()) GTEST_SKIP() << "PENUMBRA_FULL is not set";
  PENUMBRA_REQUIRE_DATA();
  const TriangleMesh mesh = load_mesh(
      test::data_folder() / "robots/xarm7/xarm_description/meshes/xarm7/visual/link_base.STL");
  for (const double depth : {0.002, 0.004})
    expect_eroded(mesh, offset_surface(mesh, -depth), depth, {2000, 500});
}

TEST(OffsetGridFull, EveryClosedLinkOfARealRobot) {
  if (!test::measures_in_full()) GTEST_SKIP() << "PENUMBRA_FULL is not set";
  PENUMBRA_REQUIRE_DATA();
  constexpr std::size_t most_triangles = 300'000;
  const auto folder = test::data_folder() / "robots/ur5e/ur_description/meshes/ur5e/collision";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const TriangleMesh mesh = load_mesh(entry.path());
    const auto start = std::chrono::steady_clock::now();
    const TriangleMesh eroded = offset_surface(mesh, -0.002);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::cout << entry.path().filename() << " in " << took.count() << " s: ";
    expect_eroded(mesh, eroded, 0.002, {5000, 1000});
    EXPECT_LT(eroded.triangles.size(), most_triangles);
  }
}

}  // namespace
}  // namespace penumbra
