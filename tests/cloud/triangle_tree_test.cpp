// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"
#include "shapes.hpp"

#include <penumbra/mesh/triangle_tree.hpp>

namespace penumbra::test {
namespace {

constexpr double corner_rounding = 1e-6;  // metres, of corners in float32

Vector3d random_vector(std::mt19937_64& random, double extent) {
  std::uniform_real_distribution<double> number(-extent, extent);
  return {number(random), number(random), number(random)};
}

/// The signed distance from a box about the origin.
double from_box(const Vector3d& point, const Vector3d& half_size) {
  const Eigen::Array3d q = point.array().abs() - half_size.array();
  return q.max(0.0).matrix().norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(TriangleTree, RaysMeetABoxWhereTheyEnterIt) {
  std::mt19937_64 random = seeded_random(421);
  const Vector3d half(0.3, 0.2, 0.5);
  const TriangleTree tree{PreparedMesh(box(half.cast<float>()))};
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d from = random_vector(random, 2.0);
    if (from_box(from, half) < corner_rounding) continue;
    const Vector3d along = (random_vector(random, 0.6) - from).normalized();
    const Vector3d rim = Vector3d::Constant(corner_rounding);
    const auto enter = enter_box(from, along, half);
    if (enter_box(from, along, half - rim).has_value() !=
        enter_box(from, along, half + rim).has_value())
      continue;  // touches an edge
    const double t = tree.first_hit(from, along);
    if (enter) {
      ++hits;
      ASSERT_NEAR(t, *enter, corner_rounding);
      ASSERT_EQ(tree.first_hit(from, along, *enter - corner_rounding), TriangleTree::nowhere);
    } else {
      ASSERT_EQ(t, TriangleTree::nowhere);
    }
  }
  EXPECT_GT(hits, 4'000);
}

/// Rays at corners and along edges are those that a careless test lets through.
TEST(TriangleTree, NoRaySlipsThroughAClosedMesh) {
  std::mt19937_64 random = seeded_random(422);
  const TriangleMesh mesh = sphere(1.0F, 40);
  const TriangleTree tree{PreparedMesh(mesh)};
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>(),
                   b = mesh.vertices[triangle[1]].cast<double>();
    const Vector3d from = random_vector(random, 0.5);
    for (const Vector3d& at : {a, Vector3d(a + share(random) * (b - a))})
      ASSERT_NEAR(tree.first_hit(from, at - from), 1.0, 1e-3) << at.transpose();
  }
}

TEST(TriangleTree, DistanceAndInsideAreThoseOfABox) {
  std::mt19937_64 random = seeded_random(423);
  const Vector3d half(0.3, 0.2, 0.5);
  const TriangleTree tree{PreparedMesh(box(half.cast<float>()))};
  const TriangleTree inwards{PreparedMesh(mirrored(box(half.cast<float>())))};
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d point = random_vector(random, 0.8);
    const double expected = from_box(point, half);
    if (std::abs(expected) < corner_rounding) continue;
    ASSERT_NEAR(tree.distance(point), std::abs(expected), corner_rounding);
    ASSERT_EQ(tree.distance(point, std::abs(expected) - corner_rounding), TriangleTree::nowhere);
    ASSERT_EQ(tree.encloses(point), expected < 0.0) << point.transpose();
    ASSERT_EQ(inwards.encloses(point), expected < 0.0) << point.transpose();
  }
}

TEST(TriangleTree, ASmallHoleLetsNoPointOut) {
  std::mt19937_64 random = seeded_random(424);
  TriangleMesh mesh = sphere(0.5F, 24);
  mesh.triangles.erase(mesh.triangles.begin() + 500);
  const TriangleTree tree{PreparedMesh(mesh)};
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d point = random_vector(random, 1.0);
    const bool is_inside = point.norm()<0.45, is_outside = point.cwiseAbs().maxCoeff()> 0.5;
    if (is_inside || is_outside) {
      ASSERT_EQ(tree.encloses(point), is_inside) << point.transpose();
    }
  }
}

}  // namespace
}  // namespace penumbra::test
