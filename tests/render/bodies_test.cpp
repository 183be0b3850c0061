// SPDX-License-Identifier: Apache-2.0
// Which bodies and meshes are drawn, and that frames do not depend on each other.
#include "render_test.hpp"
#include "shapes.hpp"

namespace penumbra::test {
namespace {

PENUMBRA_RENDER_TEST(Bodies, 2);

TEST_P(Bodies, PiercedBodiesShowTheirInsidesThroughTheirHoles) {
  std::mt19937_64 random = seeded_random(63);
  std::size_t seen_inside = 0;
  for (int round = 0; round < samples(12); ++round) {
    TriangleMesh pierced = sphere(0.3F, 24);
    const auto victim = std::size_t(random() % pierced.triangles.size());
    const Vector3f hole = pierced.vertices[pierced.triangles[victim][0]];
    pierced.triangles.erase(pierced.triangles.begin() + std::ptrdiff_t(victim));
    if (round % 3 == 0) pierced = mirrored(pierced);
    if (round % 4 == 0) std::swap(pierced.triangles[5][0], pierced.triangles[5][1]);
    // The hole turned towards the camera, more or less; now and then very close to it.
    const Eigen::Quaterniond to_camera =
        turn((round % 3 == 0 ? Vector3f(-hole.x(), hole.y(), hole.z()) : hole).cast<double>(),
             Vector3d(0.1 * round, 0.2, -1.0));
    Scene scene;
    scene.add(pierced, at(0.02, -0.03, round % 2 == 0 ? 0.9 : 0.35) * to_camera);
    const Frame frame = render(small_camera, scene);
    expect_agrees_with_brute_force(frame.view(), scene, small_camera);
    const double far_side = scene.poses[0].translation().z();
    for (const auto [u, v] : each_pixel(small_camera))
      seen_inside += frame.depth(u, v) > far_side ? 1 : 0;
  }
  EXPECT_GT(seen_inside, sanitized ? 0U : 100U);
}

TEST_P(Bodies, SurfacesThatShowTheirBacksFromOutsideAreDrawnWhole) {
  // A flask with an open neck of 4 cm, through which a tube from its bottom shows its back.
  const auto flask = [](float top) {
    return revolved(
        {{0.0F, top}, {0.01F, top}, {0.01F, 0.0F}, {0.4F, 0.0F}, {0.4F, 0.6F}, {0.02F, 0.7F}}, 24);
  };
  // A closed pin whose collar is turned inside out.
  const TriangleMesh pin = revolved(
      {{0.0F, -0.2F}, {0.05F, -0.2F}, {0.05F, 0.2F}, {0.15F, 0.2F}, {0.15F, 0.12F}, {0.0F, 0.12F}},
      48);
  std::mt19937_64 random = seeded_random(64);
  for (const TriangleMesh& mesh : {flask(0.5F), flask(0.9F), pin})
    for (int round = 0; round < samples(6); ++round) {
      Scene scene;
      scene.add(mesh, random_pose(random, {-0.1, -0.1, 1.5}, {0.1, 0.1, 2.0}));
      expect_agrees_with_brute_force(render(small_camera, scene).view(), scene, small_camera);
    }
}

TEST_P(Bodies, FramesTakenAheadComeInOrderAndDependOnTheirPosesAlone) {
  std::mt19937_64 random = seeded_random(62);
  Scene scene;
  scene.add(box({0.2F, 0.1F, 0.3F}));
  scene.add(sphere(0.15F, 12));
  scene.add(triangle_soup(random, 6, 0.4F));
  std::vector<std::vector<Isometry3d>> frames;
  std::vector<Frame> expected;  // by renderers that drew nothing else
  for (int i = 0; i < 20; ++i) {
    // One in seven is empty, and in one bodies reach through the camera.
    const double nearest = i % 7 == 3 ? -3.0 : i % 7 == 5 ? -0.3 : 0.6;
    for (auto& pose : scene.poses)
      pose = random_pose(random, {-0.6, -0.4, nearest}, {0.6, 0.4, nearest + 1.0});
    frames.push_back(scene.poses);
    expected.push_back(render(small_camera, scene));
  }
  const auto ahead = make(GetParam(), small_camera, scene.bodies());
  for (int depth = 1; depth <= ahead->max_pending(); ++depth) {
    std::size_t collected = 0;
    const auto collect = [&] {
      const VirtualDepthView view = ahead->collect();
      expect_consistent(view, small_camera, scene.poses.size());
      expect_same_bits(view, expected[collected++].view());
    };
    for (const auto& poses : frames) {
      ahead->submit(poses);
      if (ahead->pending() == depth) collect();
    }
    while (ahead->pending() > 0) collect();
    EXPECT_EQ(collected, frames.size());
  }
}

}  // namespace
}  // namespace penumbra::test
