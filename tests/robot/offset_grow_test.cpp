// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>
#include <tests/robot/offset_oracle.hpp>
#include <tests/robot/offset_shapes.hpp>
#include <tests/support/data.hpp>
#include <tests/support/random.hpp>
#include <tests/support/run_length.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/mesh_file.hpp>
#include <penumbra/robot/primitives.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using test::append;
using test::corner_rounding;
using test::crumpled;
using test::extrude;
using test::volume;

TriangleMesh l_shape() {
  return extrude({{0, 0}, {0.2, 0}, {0.2, 0.05}, {0.05, 0.05}, {0.05, 0.2}, {0, 0.2}}, 0.1);
}

TriangleMesh torus(double ring, double tube, std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double a = 2 * std::numbers::pi * i / n;
      const double b = 2 * std::numbers::pi * j / n;
      const double r = ring + tube * std::cos(b);
      mesh.vertices.push_back(
          Vector3d(r * std::cos(a), r * std::sin(a), tube * std::sin(b)).cast<float>());
      const std::uint32_t p = i * n + j;
      const std::uint32_t q = (i + 1) % n * n + j;
      const std::uint32_t s = i * n + (j + 1) % n;
      const std::uint32_t t = (i + 1) % n * n + (j + 1) % n;
      mesh.triangles.push_back({p, q, t});
      mesh.triangles.push_back({p, t, s});
    }
  }
  return mesh;
}

/// Rays from outside hit `grown` where the exact offset surface of `mesh` lies, whether or not back
/// faces are culled.
void expect_offset(const TriangleMesh& mesh, const TriangleMesh& grown, double margin,
                   int most_rays) {
  const int rays = test::samples(most_rays);
  auto random = test::seeded_random(31);
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v.cast<double>());
  const double far = box.diagonal().norm() + 3 * margin;
  std::uniform_real_distribution<double> share(-0.5, 0.5);
  double deepest = 0.0;
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    const Vector3d eye = box.center() + far * test::random_direction(random);
    const Vector3d spread(share(random), share(random), share(random));
    const Vector3d aim =
        box.center() + spread.cwiseProduct(box.sizes() + Vector3d::Constant(2 * margin));
    const Vector3d ray = (aim - eye).normalized();
    for (const bool cull_backs : {false, true}) {
      const auto hit = test::cast(grown, eye, ray, cull_backs);
      if (!hit) {
        ASSERT_FALSE(test::comes_within(mesh, eye, ray,
                                        margin * (1 - offset_error) - corner_rounding, 2 * far))
            << "a hole: ray " << i << ", culled " << cull_backs;
        continue;
      }
      ++hits;
      const double d = test::distance(mesh, *hit);
      ASSERT_LE(d, margin + corner_rounding) << "ray " << i << ", culled " << cull_backs;
      ASSERT_GE(d, margin * (1 - offset_error) - corner_rounding)
          << "ray " << i << ", culled " << cull_backs;
      deepest = std::max(deepest, margin - d);
    }
  }
  std::cout << mesh.triangles.size() << " -> " << grown.triangles.size() << " triangles, " << hits
            << " hits, deepest " << 100 * deepest / margin << " % of the margin\n";
  EXPECT_GT(hits, rays / 2);
}

void expect_closed(const TriangleMesh& grown) {
  const TriangleMesh welded = weld(grown);
  for (const MeshComponent& piece : connected_components(welded)) EXPECT_TRUE(piece.closed);
  EXPECT_FALSE(welded.triangles.empty());
}

TEST(OffsetGrow, ZeroReturnsTheMesh) {
  const TriangleMesh box = make_box({1, 2, 3});
  EXPECT_EQ(offset_surface(box, 0.0).triangles, box.triangles);
}

TEST(OffsetGrow, MarginMustBeFinite) {
  EXPECT_THROW((void)offset_surface(make_sphere(1), std::nan("")), InputError);
  EXPECT_THROW((void)offset_surface(make_sphere(1), HUGE_VAL), InputError);
}

TEST(OffsetGrow, VolumesAreTheClosedForms) {
  for (const double m : {0.001, 0.01, 0.1}) {
    const Vector3d s(0.3, 0.2, 0.1);
    const double area = 2 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
    const double round =
        std::numbers::pi * m * m * s.sum() + 4.0 / 3.0 * std::numbers::pi * m * m * m;
    const TriangleMesh box = offset_surface(make_box(s), m);
    expect_closed(box);
    const double exact = s.prod() + area * m + round;
    EXPECT_LE(volume(box), exact * (1 + corner_rounding));
    // Faces are exact; what is round is at most offset_error of the margin short.
    EXPECT_GE(volume(box), exact - 3 * offset_error * round - exact * corner_rounding);

    const double r = 0.05;
    const TriangleMesh ball = make_sphere(r);
    const TriangleMesh grown = offset_surface(ball, m);
    expect_closed(grown);
    const double inner = r + m * (1 - offset_error) - primitive_error;
    const double outer = r + m + primitive_error;
    EXPECT_GE(volume(grown), 4.0 / 3.0 * std::numbers::pi * inner * inner * inner);
    EXPECT_LE(volume(grown), 4.0 / 3.0 * std::numbers::pi * outer * outer * outer);

    const double l = 0.2;
    const TriangleMesh rod = offset_surface(make_cylinder(r, l), m);
    expect_closed(rod);
    const double whole =
        std::numbers::pi * (r + m) * (r + m) * l +
        2 * (std::numbers::pi * r * r * m + std::numbers::pi * std::numbers::pi * r * m * m / 2 +
             2.0 / 3.0 * std::numbers::pi * m * m * m);
    const double skin = 2 * std::numbers::pi * (r + m) * (l + 2 * (r + m));
    EXPECT_NEAR(volume(rod), whole, skin * (offset_error * m + 2 * primitive_error));
  }
}

TEST(OffsetGrow, SmoothMeshesKeepTheirCounts) {
  const TriangleMesh ball = make_sphere(0.1);
  EXPECT_EQ(offset_surface(ball, 0.01).triangles.size(), ball.triangles.size());
}

TEST(OffsetGrow, ConvexAndConcaveSolids) {
  for (const double m : {0.002, 0.02, 0.1}) {
    for (const TriangleMesh& mesh :
         {make_box({0.3, 0.2, 0.1}), make_cylinder(0.04, 0.1), l_shape(), torus(0.1, 0.03, 24)}) {
      const TriangleMesh grown = offset_surface(mesh, m);
      expect_offset(mesh, grown, m, 400);
      if (m < 0.1) expect_closed(grown);
    }
  }
}

TEST(OffsetGrow, CrumpledSolids) {
  auto random = test::seeded_random(32);
  for (const double amount : {0.1, 0.3, 0.6}) {
    for (const double m : {0.002, 0.01, 0.04}) {
      const TriangleMesh mesh = crumpled(random, amount);
      const TriangleMesh grown = offset_surface(mesh, m);
      expect_offset(mesh, grown, m, 400);
      expect_closed(grown);
    }
  }
}

TEST(OffsetGrow, SpikesAndWedges) {
  const TriangleMesh wedge = extrude({{0, 0}, {0.2, 0}, {0.2, 0.002}}, 0.1);
  const TriangleMesh needle = {
      {{0, 0, 0.3F}, {0.002F, 0, 0}, {0, 0.002F, 0}, {-0.002F, -0.001F, 0}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  for (const TriangleMesh& mesh : {wedge, needle}) {
    ASSERT_GT(volume(mesh), 0.0);
    expect_offset(mesh, offset_surface(mesh, 0.01), 0.01, 400);
  }
}

TEST(OffsetGrow, InsideOutSolidsGrowOutwards) {
  TriangleMesh box = make_box({0.3, 0.2, 0.1});
  for (auto& t : box.triangles) std::swap(t[0], t[1]);
  const TriangleMesh grown = offset_surface(box, 0.01);
  expect_closed(grown);
  EXPECT_GT(volume(grown), 0.3 * 0.2 * 0.1);
}

TEST(OffsetGrow, OpenMeshesGrowOnBothSides) {
  TriangleMesh open_box = make_box({0.3, 0.2, 0.1});
  open_box.triangles.resize(9);
  TriangleMesh sheet = {{{0, 0, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}}, {{0, 1, 2}}};
  TriangleMesh fins = sheet;  // three more triangles at one edge, one wound the wrong way
  fins.vertices.insert(fins.vertices.end(),
                       {{0.1F, 0, 0.2F}, {0.1F, -0.1F, 0.1F}, {0.1F, 0.1F, 0.2F}});
  fins.triangles.insert(fins.triangles.end(), {{0, 1, 3}, {1, 0, 4}, {0, 1, 5}});
  for (const double m : {0.002, 0.02}) {
    for (const TriangleMesh& mesh : {open_box, sheet, fins}) {
      const TriangleMesh grown = offset_surface(mesh, m);
      expect_closed(grown);
      expect_offset(mesh, grown, m, 400);
    }
  }
}

TEST(OffsetGrow, SeveralPieces) {
  TriangleMesh mesh = make_box({0.1, 0.1, 0.1});
  append(mesh, make_sphere(0.03), {0.06, 0, 0});
  append(mesh, {{{0, 0, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}}, {{0, 1, 2}}}, {0, 0, 0.1});
  expect_offset(mesh, offset_surface(mesh, 0.01), 0.01, 400);
}

TEST(OffsetGrow, RealLinks) {
  PENUMBRA_REQUIRE_DATA();
  const auto robots = test::data_folder() / "robots";
  for (const char* file : {"ur5e/ur_description/meshes/ur5e/collision/forearm.stl",
                           "xarm7/xarm_description/meshes/xarm7/visual/link3.STL"}) {
    const TriangleMesh mesh = load_mesh(robots / file);
    for (const double m : {0.002, 0.05}) {
      const TriangleMesh grown = offset_surface(mesh, m);
      expect_offset(mesh, grown, m, 100);
    }
  }
}

struct Growth {
  std::size_t given = 0, grown = 0;
  bool closed = true;
};

Growth grow_folder(const std::filesystem::path& folder) {
  Growth growth;
  const auto start = std::chrono::steady_clock::now();
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const TriangleMesh mesh = load_mesh(entry.path());
    const TriangleMesh grown = offset_surface(mesh, 0.01);
    growth.given += mesh.triangles.size();
    growth.grown += grown.triangles.size();
    growth.closed = growth.closed && is_watertight(weld(grown));
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::cout << folder << ": " << growth.given << " -> " << growth.grown << " triangles, "
            << took.count() << " s\n";
  return growth;
}

TEST(OffsetGrow, RealRobotsStaySmallAndClosed) {
  PENUMBRA_REQUIRE_DATA();
  const auto robots = test::data_folder() / "robots";
  const Growth ur5e = grow_folder(robots / "ur5e/ur_description/meshes/ur5e/collision");
  EXPECT_TRUE(ur5e.closed);
  EXPECT_LT(ur5e.grown, 4 * ur5e.given);
  if (test::sanitized) return;  // the larger robot runs through the same code
  const Growth xarm = grow_folder(robots / "xarm7/xarm_description/meshes/xarm7/visual");
  EXPECT_TRUE(xarm.closed);
  EXPECT_LT(xarm.grown, 12 * xarm.given);  // threads and holes: each sharp edge is rounded
}

}  // namespace
}  // namespace penumbra
