// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tests/support/random.hpp>

#include <penumbra/mesh/mesh_formats-inl.hpp>

namespace penumbra {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double area_rounding = 1e-5;  // of areas of a few square metres from float corners

double shoelace(const Points& points) {
  double twice = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d& a = points[i];
    const Eigen::Vector2d& b = points[(i + 1) % points.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2.0;
}

TriangleMesh cut(const Points& points, const Eigen::Isometry3d& place) {
  TriangleMesh mesh;
  for (const Eigen::Vector2d& p : points)
    mesh.vertices.push_back((place * Eigen::Vector3d(p.x(), p.y(), 0.0)).cast<float>());
  std::vector<std::uint32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0U);
  mesh_formats::append_polygon(corners, mesh);
  return mesh;
}

/// The triangles are wound as the polygon is and together have its area: they cover it once.
void expect_covered(const Points& points, const Eigen::Isometry3d& place) {
  const TriangleMesh mesh = cut(points, place);
  EXPECT_EQ(mesh.triangles.size(), points.size() - 2);
  const Eigen::Vector3d normal = place.linear().col(2) * (shoelace(points) < 0.0 ? -1.0 : 1.0);
  double area = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d twice =
        (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
    EXPECT_GT(twice.dot(normal), -area_rounding);
    area += twice.norm() / 2.0;
  }
  EXPECT_NEAR(area, std::abs(shoelace(points)), area_rounding);
}

Eigen::Isometry3d random_place(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.linear() =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
          .normalized()
          .toRotationMatrix();
  return place;
}

TEST(Polygon, RandomStarsAreCoveredOnce) {
  auto random = test::seeded_random(21);
  std::uniform_real_distribution<double> radius(0.1, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    Points points;
    const std::size_t corners = 3 + random() % 40;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle =
          2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
      points.emplace_back(radius(random) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    if (trial % 2 == 0) std::reverse(points.begin(), points.end());
    SCOPED_TRACE(trial);
    expect_covered(points, random_place(random));
  }
}

TEST(Polygon, CombsAndCornersOnALineAreCoveredOnce) {
  auto random = test::seeded_random(22);
  Points comb;
  for (int i = 0; i < 50; ++i) comb.emplace_back(0.02 * i, i % 2 == 0 ? 0.0 : 0.9);
  comb.emplace_back(1.0, 1.0);
  comb.emplace_back(0.0, 1.0);
  expect_covered(comb, random_place(random));
  expect_covered({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}},
                 Eigen::Isometry3d::Identity());
  expect_covered({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}}, Eigen::Isometry3d::Identity());
}

TEST(Polygon, ALargeOneIsCutQuickly) {
  Points circle;
  for (int i = 0; i < 4000; ++i)
    circle.emplace_back(std::cos(i * std::numbers::pi / 2000),
                        std::sin(i * std::numbers::pi / 2000));
  expect_covered(circle, Eigen::Isometry3d::Identity());
  circle.emplace_back(1.0, -1e-4);
  EXPECT_THROW(cut(circle, Eigen::Isometry3d::Identity()), mesh_formats::FormatError);
}

TEST(Polygon, OneThatCrossesItselfIsCut) {
  const Points crossing{{0, 0}, {2, 1}, {2, 0}, {0, 1}, {-1, 0.5}};
  EXPECT_EQ(cut(crossing, Eigen::Isometry3d::Identity()).triangles.size(), 3U);
}

}  // namespace
}  // namespace penumbra
