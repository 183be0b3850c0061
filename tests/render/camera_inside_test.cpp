// SPDX-License-Identifier: Apache-2.0
#include "random.hpp"
#include "scene.hpp"
#include "shapes.hpp"

#include <algorithm>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

using Eigen::Vector3d;

TEST(CameraInside, TellsTheFirstBodyThatHoldsTheCamera) {
  Scene scene;
  scene.add(box({0.1F, 0.1F, 0.1F}), at(0, 0, 1));
  scene.add(sphere(0.3F, 10), at(0, 0, 0.2));
  scene.add(box({1.0F, 1.0F, 1.0F}));
  CameraInsideCheck check(scene.bodies());
  EXPECT_EQ(check.find(scene.poses), 1U);
  scene.poses[1] = at(0, 0, 0.5);
  EXPECT_EQ(check.find(scene.poses), 2U);
  scene.poses[2] = at(3, 0, 0);
  EXPECT_EQ(check.find(scene.poses), std::nullopt);
  scene.poses[1] = at(0, 0, 0.2);
  EXPECT_EQ(check.find(scene.poses), 1U);
}

/// A mesh without the triangles that have a corner there.
TriangleMesh cut(TriangleMesh mesh, const std::function<bool(const Eigen::Vector3f&)>& there) {
  std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& corners) {
    return std::any_of(corners.begin(), corners.end(),
                       [&](std::uint32_t i) { return there(mesh.vertices[i]); });
  });
  return mesh;
}

TEST(CameraInside, AnOpenPieceHoldsWhatItClosesAroundForMoreThanHalf) {
  // As meshes for the eye are: a cylinder without its ends, a shell that is no body.
  const TriangleMesh ball = sphere(0.3F, 24);
  const TriangleMesh most = cut(ball, [](const auto& p) { return p.z() > 0.1F; });
  const TriangleMesh least = cut(ball, [](const auto& p) { return p.z() > -0.1F; });
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

TEST(CameraInside, SmallHolesLetNobodyOut) {
  Scene scene;
  TriangleMesh pierced = sphere(0.3F, 24);
  pierced.triangles.erase(pierced.triangles.begin() + 200);
  scene.add(pierced, at(0.1, 0, 0.1));
  EXPECT_EQ(CameraInsideCheck(scene.bodies()).find(scene.poses), 0U);
  scene.poses[0] = at(0.1, 0, 0.4);
  EXPECT_EQ(CameraInsideCheck(scene.bodies()).find(scene.poses), std::nullopt);
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
