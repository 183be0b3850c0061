// SPDX-License-Identifier: Apache-2.0
// What passes through, behind and around the camera.
#include "../support/test.hpp"
#include "render_test.hpp"
#include "scene.hpp"
#include "shapes.hpp"

#include <penumbra/render/near_plane_check.hpp>

namespace penumbra::test {
namespace {

PENUMBRA_RENDER_TEST(NearPlane, 2);

TEST_P(NearPlane, NothingNearerThanTheNearPlane) {
  for (const double z : {-1.0, 0.0, 0.005, 0.00999, 0.0101}) {
    Scene scene;
    scene.add(quad({-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}), at(0, 0, z));
    const Frame frame = render(near_camera, scene);
    EXPECT_EQ(frame.covered(), z > DepthRenderer::near_plane ? frame.depth.size() : 0U) << z;
  }
}

TEST_P(NearPlane, ClosedBodiesGrazedByTheNearPlane) {
  std::mt19937_64 random = seeded_random(52);
  std::uniform_real_distribution<double> gap(0.0005, 0.02);
  std::normal_distribution<double> normal;
  for (int round = 0; round < samples(30); ++round) {
    Scene scene;
    const double radius = 0.15, x = normal(random), y = normal(random);
    const Vector3d side = Vector3d(x, y, std::abs(normal(random)) + 0.3).normalized();
    const Vector3d centre = side * (radius + gap(random));
    scene.add(sphere(float(radius), 10), random_pose(random, centre, centre));
    expect_agrees_with_brute_force(render(near_camera, scene).view(), scene, near_camera);
  }
}

TEST_P(NearPlane, RandomScenesAllAroundTheCamera) {
  std::mt19937_64 random = seeded_random(54);
  for (int round = 0; round < samples(25); ++round) {
    Scene scene;
    scene.add(triangle_soup(random, 12, 1.5F), at(0, 0, 0.8));
    scene.add(triangle_soup(random, 4, 10.0F));
    scene.add(sphere(0.2F, 9), random_pose(random, {0.3, -0.4, -0.3}, {0.6, 0.4, 1.5}));
    scene.add(mirrored(sphere(0.15F, 9)), random_pose(random, {-0.6, -0.4, 0}, {-0.2, 0.4, 1.5}));
    scene.add(box({0.1F, 0.1F, 0.4F}), random_pose(random, {-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}));
    expect_agrees_with_brute_force(render(near_camera, scene).view(), scene, near_camera);
  }
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
    scene.add(TriangleMesh{});
    scene.add(quad({-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}), at(0, 0, 2));
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
        deepest = std::max(deepest, depth_in_pyramid(scene.poses[2] * p));
      }
    const auto bodies = scene.bodies();
    NearPlaneCheck check(near_camera, bodies);
    const auto found = check.find(scene.poses);
    const bool answer = !found.empty();
    EXPECT_TRUE(!answer || (found.size() == 1 && found[0] == 2)) << round;
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

TEST(CameraInside, AnOpenPieceHoldsWhatItClosesAroundForMoreThanHalf) {
  // As meshes for the eye are: a cylinder without its ends, a shell that is no body.
  const TriangleMesh ball = sphere(0.3F, 24);
  const TriangleMesh most = cut_above(ball, 0.1F), least = cut_above(ball, -0.1F);
  for (const TriangleMesh& mesh : {most, mirrored(most)}) {
    Scene scene;
    scene.add(mesh);
    EXPECT_EQ(CameraInsideCheck(scene.bodies()).find(scene.poses), 0U);
    scene.poses[0] = at(0, 0, 0.4);
    EXPECT_EQ(CameraInsideCheck(scene.bodies()).find(scene.poses), std::nullopt);
  }
  Scene scene;
  scene.add(least);
  EXPECT_EQ(CameraInsideCheck(scene.bodies()).find(scene.poses), std::nullopt)
      << "a bowl, from above its rim";
}

TEST(CameraInside, AgreesWithTheFormulaOfABox) {
  std::mt19937_64 random = seeded_random(91);
  Scene scene;
  const Vector3d half(0.3, 0.2, 0.1);
  scene.add(box(half.cast<float>()));
  CameraInsideCheck check(scene.bodies());
  int inside_count = 0;
  for (int round = 0; round < 400; ++round) {
    scene.poses[0] = random_pose(random, {-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3});
    const Vector3d camera = scene.poses[0].inverse() * Vector3d::Zero();
    const bool inside = (camera.cwiseAbs() - half).maxCoeff() < 0.0;
    inside_count += inside ? 1 : 0;
    EXPECT_EQ(check.find(scene.poses).has_value(), inside) << round;
  }
  EXPECT_GT(inside_count, 20);
}

}  // namespace
}  // namespace penumbra::test
