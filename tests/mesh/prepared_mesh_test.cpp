// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tests/support/random.hpp>
#include <tests/support/run_length.hpp>
#include <tests/support/shapes.hpp>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

using test::append;
using test::revolved;

TriangleMesh torus(std::uint32_t rows, std::uint32_t columns) {
  return test::torus(rows, columns, 0.3, 0.1);
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

std::vector<PatchOrientation> orientations(const TriangleMesh& mesh) {
  return PreparedMesh(mesh).orientations();
}

TEST(PreparedMesh, ClosedPatchesFaceOneWayAndHaveNoHoles) {
  TriangleMesh mesh = torus(12, 8);
  append(mesh, turned(torus(10, 7)));
  const PreparedMesh prepared(mesh);
  ASSERT_EQ(prepared.patches.size(), 2U);
  EXPECT_EQ(prepared.patches[0].triangles.size(), 2U * 12 * 8);
  EXPECT_TRUE(prepared.watertight);
  EXPECT_EQ(prepared.orientations()[0].facing, Facing::outwards);
  EXPECT_EQ(prepared.orientations()[1].facing, Facing::inwards);
  EXPECT_TRUE(prepared.orientations()[0].holes.empty());
  const PreparedMesh copy = prepared;
  EXPECT_EQ(&copy.orientations(), &prepared.orientations()) << "found once";
}

/// A flask 0.8 m wide whose neck of 4 cm is open, with a tube from its bottom up to `top`.
TriangleMesh flask_with_stem(float top) {
  return revolved({{0.0F, top},
                   {0.01F, top},
                   {0.01F, 0.3F},
                   {0.01F, 0.0F},
                   {0.4F, 0.0F},
                   {0.4F, 0.6F},
                   {0.02F, 0.7F}},
                  24);
}

TEST(PreparedMesh, APatchThatPassesThroughItsOwnHoleIsNoBody) {
  // Outside, above the neck, the stem would show its back first.
  EXPECT_EQ(orientations(flask_with_stem(0.5F))[0].facing, Facing::outwards);
  EXPECT_EQ(orientations(flask_with_stem(0.9F))[0].facing, Facing::unknown);
}

TEST(PreparedMesh, AClosedPatchThatShowsItsBackIsTrustedNeitherWay) {
  // A pin whose collar is turned inside out: its profile goes outwards, down and in through the
  // pin.
  const TriangleMesh pin = revolved(
      {{0.0F, -0.2F}, {0.05F, -0.2F}, {0.05F, 0.2F}, {0.15F, 0.2F}, {0.15F, 0.12F}, {0.0F, 0.12F}},
      48);
  const PreparedMesh prepared(pin);
  ASSERT_EQ(prepared.patches.size(), 1U);
  EXPECT_TRUE(prepared.patches[0].closed);
  EXPECT_EQ(prepared.orientations()[0].facing, Facing::unknown);
}

struct Ray {
  Vector3d origin, direction;
};

struct Hit {
  double t;
  bool front;
};

/// The first hit of a ray on some triangles (Moeller and Trumbore 1997), or none.
std::optional<Hit> cast(const Ray& ray, const TriangleMesh& mesh, const SurfacePatch& patch) {
  std::optional<Hit> nearest;
  for (const std::uint32_t i : patch.triangles) {
    const auto& [ia, ib, ic] = mesh.triangles[i];
    const Vector3d a = mesh.vertices[ia].cast<double>();
    const Vector3d ab = mesh.vertices[ib].cast<double>() - a;
    const Vector3d ac = mesh.vertices[ic].cast<double>() - a;
    const Vector3d p = ray.direction.cross(ac);
    const double det = ab.dot(p);
    const Vector3d s = ray.origin - a;
    const double u = s.dot(p) / det;
    const double v = ray.direction.dot(s.cross(ab)) / det;
    const double t = ac.dot(s.cross(ab)) / det;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0)) continue;
    if (!nearest || t < nearest->t) nearest = Hit{t, det > 0};
  }
  return nearest;
}

bool passes(const Ray& ray, const Ball& ball) {
  return (ball.centre - ray.origin).cross(ray.direction).norm() <=
         ball.radius * ray.direction.norm();
}

TEST(PreparedMesh, RaysFromOutsideMeetOuterSidesFirstOrGoThroughHoles) {
  std::mt19937_64 random = test::seeded_random(311);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> near(-0.4, 0.4);
  int known = 0;
  int backs = 0;
  for (int round = 0; round < test::samples(40); ++round) {
    TriangleMesh mesh = torus(48, 32);
    for (int i = 0; i < 1 + round % 6; ++i) {
      const auto victim = static_cast<std::ptrdiff_t>(random() % mesh.triangles.size());
      auto& t = mesh.triangles[static_cast<std::size_t>(victim)];
      if (random() % 3 == 0) std::swap(t[0], t[1]);
      if (random() % 2 == 0) mesh.triangles.erase(mesh.triangles.begin() + victim);
    }
    const PreparedMesh prepared(mesh);
    for (std::size_t number = 0; number < prepared.patches.size(); ++number) {
      const auto& [facing, holes] = prepared.orientations()[number];
      if (facing == Facing::unknown) continue;
      ++known;
      for (int i = 0; i < 200; ++i) {
        // Half of the rays aim at a hole, where backs are to be seen.
        Vector3d aim(near(random), near(random), 0.3 * near(random));
        if (i % 2 == 0 && !holes.empty()) {
          const Ball& hole = holes[random() % holes.size()];
          aim = hole.centre + hole.radius * aim;
        }
        const Vector3d origin =
            2.0 * Vector3d(normal(random), normal(random), normal(random)).normalized();
        const Ray ray{origin, aim - origin};
        const auto hit = cast(ray, prepared, prepared.patches[number]);
        if (!hit || hit->front == (facing == Facing::outwards)) continue;
        ++backs;
        EXPECT_TRUE(std::any_of(holes.begin(), holes.end(),
                                [&](const Ball& hole) { return passes(ray, hole); }));
      }
    }
  }
  EXPECT_GT(known, test::samples(20));
  EXPECT_GT(backs, test::samples(100));
}

}  // namespace
}  // namespace penumbra
