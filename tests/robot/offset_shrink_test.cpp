// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <tests/robot/offset_oracle.hpp>
#include <tests/robot/offset_shapes.hpp>
#include <tests/support/random.hpp>
#include <tests/support/run_length.hpp>

#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/primitives.hpp>
#include <penumbra/robot/surface_erosion-inl.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using test::corner_rounding;
using test::refusal;
using test::volume;

/// Random points of the shrunk surface lie at the depth from the old one.
void expect_depth(const TriangleMesh& mesh, const TriangleMesh& shrunk, double depth) {
  EXPECT_TRUE(is_watertight(weld(shrunk)));
  auto random = test::seeded_random(41);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < test::samples(2000); ++i) {
    const auto [a, b, c] = test::corners(shrunk, random() % shrunk.triangles.size());
    const double u = std::sqrt(share(random));
    const double v = share(random);
    const Vector3d p = (1 - u) * a + u * (1 - v) * b + u * v * c;
    worst = std::max(worst, std::abs(test::distance(mesh, p) - depth));
  }
  std::cout << "off by at most " << 100 * worst / depth << " % of the depth\n";
  EXPECT_LE(worst, offset::plane_error * depth + corner_rounding);
}

TEST(OffsetShrink, VolumesAreTheClosedForms) {
  const Vector3d size(0.3, 0.2, 0.1);
  const double r = 0.05;
  const double l = 0.2;
  for (const double m : {0.0005, 0.002, 0.01, 0.03}) {
    const TriangleMesh box = offset_surface(make_box(size), -m);
    EXPECT_NEAR(volume(box), (size - Vector3d::Constant(2 * m)).prod(), corner_rounding);
    expect_depth(make_box(size), box, m);
    const TriangleMesh ball = offset_surface(make_sphere(r), -m);
    const double slack =
        4 * std::numbers::pi * r * r * (primitive_error + 0.005 * m);  // flat faces, not a ball
    EXPECT_NEAR(volume(ball), 4.0 / 3.0 * std::numbers::pi * std::pow(r - m, 3), slack);
    expect_depth(make_sphere(r), ball, m);
    const TriangleMesh rod = offset_surface(make_cylinder(r, l), -m);
    EXPECT_NEAR(volume(rod), std::numbers::pi * (r - m) * (r - m) * (l - 2 * m),
                2 * std::numbers::pi * r * l * primitive_error);
    expect_depth(make_cylinder(r, l), rod, m);
  }
}

TEST(OffsetShrink, InsideOutSolidsShrinkInwards) {
  TriangleMesh box = make_box({0.3, 0.2, 0.1});
  for (auto& t : box.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(volume(offset_surface(box, -0.01)), 0.28 * 0.18 * 0.08, corner_rounding);
}

TEST(OffsetShrink, OpenMeshesAndVanishingBodiesAreRefused) {
  TriangleMesh open = make_box({0.3, 0.2, 0.1});
  open.triangles.pop_back();
  EXPECT_NE(refusal(open, -0.01).find("a margin of -10 mm needs a closed mesh"), std::string::npos);
  EXPECT_NE(refusal(make_box({0.3, 0.2, 0.1}), -0.0501), "");
  EXPECT_NE(refusal(make_box({0.3, 0.2, 0.1}), -0.06), "");
  EXPECT_NE(refusal(make_box({0.3, 0.2, 0.1}), -0.5), "");
  // A margin that leaves a flat body of rounded corners, a line or a point.
  for (const Eigen::Vector3d& size :
       {Eigen::Vector3d(0.2, 0.3, 0.4), Eigen::Vector3d(0.2, 0.2, 0.4),
        Eigen::Vector3d(0.2, 0.2, 0.2)}) {
    EXPECT_NE(refusal(make_box(size), -0.1), "") << size.transpose();
  }
  EXPECT_NE(refusal(make_sphere(0.05), -0.0501), "");
  EXPECT_NE(refusal(make_cylinder(0.05, 0.01), -0.006), "");
}

}  // namespace
}  // namespace penumbra
