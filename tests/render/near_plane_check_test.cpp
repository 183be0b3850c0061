// SPDX-License-Identifier: Apache-2.0
#include "random.hpp"
#include "render_test.hpp"
#include "run_length.hpp"
#include "shapes.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/render/near_plane_check.hpp>

namespace penumbra::test {
namespace {

using Eigen::Vector3d;
using Found = std::vector<std::size_t>;

/// `side` metres wide and high.
TriangleMesh plate(float side) {
  const float h = side / 2;
  return quad({-h, -h, 0}, {-h, h, 0}, {h, h, 0}, {h, -h, 0});
}

Found found(NearPlaneCheck& check, const Scene& scene) {
  const auto links = check.find(scene.poses);
  return {links.begin(), links.end()};
}

TEST(NearPlaneCheck, FindsWhatLiesBetweenTheCameraAndTheNearPlane) {
  Scene scene;
  scene.add(plate(1.0F), at(0, 0, 0.005));
  scene.add(plate(1.0F), at(0, 0, 2.0));
  scene.add(plate(1.0F), at(0, 0, -0.005));
  scene.add(plate(0.001F), at(0.001, 0.001, 0.005));
  scene.add(plate(0.001F), at(0.02, 0.0, 0.005));  // beside the image
  scene.add(TriangleMesh{});
  const auto bodies = scene.bodies();
  NearPlaneCheck check(near_camera, bodies);
  EXPECT_EQ(found(check, scene), (Found{0, 3}));
  scene.poses[0] = at(0, 0, 0.01);  // drawn
  scene.poses[1] = at(0, 0, 0.0099);
  scene.poses[3] = at(0, 0, 0.5);
  EXPECT_EQ(found(check, scene), Found{1});
  scene.poses[1] = at(0, 0, 2.0);
  EXPECT_EQ(found(check, scene), Found{});
}

/// How far a point is inside of the pyramid between camera and near plane; negative: outside.
double depth_in_pyramid(const Vector3d& p) {
  const double u_low = p.x() * near_camera.fx() + (near_camera.cx() + 0.5) * p.z();
  const double u_high =
      (near_camera.width() - 0.5 - near_camera.cx()) * p.z() - p.x() * near_camera.fx();
  const double v_low = p.y() * near_camera.fy() + (near_camera.cy() + 0.5) * p.z();
  const double v_high =
      (near_camera.height() - 0.5 - near_camera.cy()) * p.z() - p.y() * near_camera.fy();
  // Distances to the sides: each is a length times about this number of pixels.
  const double pixels = 100.0;
  return std::min({u_low / pixels, u_high / pixels, v_low / pixels, v_high / pixels,
                   DepthRenderer::near_plane - p.z()});
}

TEST(NearPlaneCheck, AgreesWithPointsOfRandomTriangles) {
  std::mt19937_64 random = seeded_random(87);
  constexpr int steps = 100;
  constexpr double spacing = 0.0006;  // metres: between points of triangles of up to 6 cm
  int reached = 0;
  for (int round = 0; round < samples(1000); ++round) {
    Scene scene;
    const TriangleMesh mesh = triangle_soup(random, 1, 0.02F);
    scene.add(mesh, random_pose(random, {-0.01, -0.01, -0.01}, {0.01, 0.01, 0.03}));
    double deepest = -1.0;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const auto& t = mesh.triangles[0];
        const Vector3d p =
            (mesh.vertices[t[0]].cast<double>() * i + mesh.vertices[t[1]].cast<double>() * j +
             mesh.vertices[t[2]].cast<double>() * (steps - i - j)) /
            steps;
        deepest = std::max(deepest, depth_in_pyramid(scene.poses[0] * p));
      }
    const auto bodies = scene.bodies();
    NearPlaneCheck check(near_camera, bodies);
    const bool answer = !check.find(scene.poses).empty();
    if (deepest > 1e-7) {
      EXPECT_TRUE(answer) << round << ' ' << deepest;
    } else if (deepest < -spacing) {
      EXPECT_FALSE(answer) << round << ' ' << deepest;
    }
    reached += answer ? 1 : 0;
  }
  EXPECT_GT(reached, samples(100));
  EXPECT_LT(reached, samples(900));
}

}  // namespace
}  // namespace penumbra::test
