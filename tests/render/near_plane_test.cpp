// SPDX-License-Identifier: Apache-2.0
// What passes through, behind and around the camera.
#include "random.hpp"
#include "render_test.hpp"
#include "run_length.hpp"
#include "shapes.hpp"

#include <cmath>
#include <random>

namespace penumbra::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

class NearPlane : public RenderTest {};
PENUMBRA_FOR_EACH_BACKEND(NearPlane, 2);

TEST_P(NearPlane, NothingNearerThanTheNearPlane) {
  for (const double z : {-1.0, 0.0, 0.005, 0.00999}) {
    Scene scene;
    scene.add(quad({-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}), at(0, 0, z));
    EXPECT_EQ(render(near_camera, scene).covered(), 0U) << z;
  }
  Scene scene;
  scene.add(quad({-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}), at(0, 0, 0.0101));
  const Frame frame = render(near_camera, scene);
  EXPECT_EQ(frame.covered(), frame.depth.size());
}

TEST_P(NearPlane, ClosedBodiesGrazedByTheNearPlane) {
  std::mt19937_64 random = seeded_random(52);
  std::uniform_real_distribution<double> gap(0.0005, 0.02);
  std::normal_distribution<double> normal;
  for (int round = 0; round < samples(30); ++round) {
    Scene scene;
    const double radius = 0.15;
    const double x = normal(random);
    const double y = normal(random);
    const Vector3d side = Vector3d(x, y, std::abs(normal(random)) + 0.3).normalized();
    const Vector3d centre = side * (radius + gap(random));
    scene.add(sphere(static_cast<float>(radius), 10), random_pose(random, centre, centre));
    expect_agrees_with_brute_force(render(near_camera, scene).view(), scene, near_camera);
  }
}

TEST_P(NearPlane, RandomScenesAllAroundTheCamera) {
  std::mt19937_64 random = seeded_random(54);
  Agreement total;
  for (int round = 0; round < samples(25); ++round) {
    Scene scene;
    scene.add(triangle_soup(random, 12, 1.5F), at(0, 0, 0.8));
    scene.add(triangle_soup(random, 4, 10.0F));
    scene.add(sphere(0.2F, 9), random_pose(random, {0.3, -0.4, -0.3}, {0.6, 0.4, 1.5}));
    scene.add(mirrored(sphere(0.15F, 9)), random_pose(random, {-0.6, -0.4, 0}, {-0.2, 0.4, 1.5}));
    scene.add(box({0.1F, 0.1F, 0.4F}), random_pose(random, {-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}));
    total += expect_agrees_with_brute_force(render(near_camera, scene).view(), scene, near_camera);
  }
  std::cout << total << '\n';
}

}  // namespace
}  // namespace penumbra::test
