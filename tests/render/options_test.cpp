// SPDX-License-Identifier: Apache-2.0
// Choosing a backend, a SIMD target and threads.
#include "render_test.hpp"
#include "shapes.hpp"

#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <penumbra/base/simd_target.hpp>

namespace penumbra::test {
namespace {

constexpr int most_threads = 4;

const Intrinsics camera(333, 217, 300.0, 300.0, 170.0, 100.0);

Scene crowded_scene() {
  std::mt19937_64 random = seeded_random(71);
  Scene scene;
  for (int i = 0; i < 8; ++i) {
    scene.add(sphere(0.1F, 20), random_pose(random, {-0.5, -0.3, 0.5}, {0.5, 0.3, 1.5}));
    scene.add(box({0.2F, 0.05F, 0.1F}), random_pose(random, {-0.5, -0.3, 0.5}, {0.5, 0.3, 1.5}));
    scene.add(triangle_soup(random, 3, 0.5F), at(0, 0, 0.4));
  }
  return scene;
}

TEST(RendererOptions, UnknownIsaIsRefusedWithTheListOfThoseThatAre) {
  expect_refused(
      [] {
        (void)make({Backend::cpu, "MMX", 1}, camera, {});
      },
      {"MMX", simd_target_names().front()});
  EXPECT_EQ(make({Backend::cpu, "", 1}, camera, {})->info().isa, simd_target_names().front());
}

TEST(Threads, AnyNumberGivesTheSameBits) {
  std::mt19937_64 random = seeded_random(72);
  Scene scene = crowded_scene();
  for (const std::string& isa : simd_target_names()) {
    std::vector<std::unique_ptr<DepthRenderer>> renderers;
    for (int threads = 1; threads <= most_threads; ++threads)
      renderers.push_back(make({Backend::cpu, isa, threads}, camera, scene.bodies()));
    for (int round = 0; round < 10; ++round) {
      for (auto& pose : scene.poses) pose = random_pose(random, {-0.5, -0.3, 0.3}, {0.5, 0.3, 1.5});
      const VirtualDepthView expected = renderers.front()->render(scene.poses);
      for (std::size_t i = 1; i < renderers.size(); ++i)
        expect_same_bits(renderers[i]->render(scene.poses), expected);
    }
  }
}

TEST(Threads, OfAParentAreMissedInAForkedProcess) {
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
  GTEST_SKIP() << "skipped: ThreadSanitizer does not follow a fork";
#endif
#endif
  Scene scene = crowded_scene();
  auto renderer = make({Backend::cpu, "", 2}, camera, scene.bodies());
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);  // ends what waits for ever
    bool is_refused = false;
    try {
      (void)renderer->render(scene.poses);
    } catch (const InputError&) {
      is_refused = true;
    }
    renderer.reset();
    _exit(is_refused ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_NO_THROW((void)renderer->render(scene.poses));
}

// What is hidden by others is not drawn at all: every body drawn alone, the nearest of each pixel.
TEST(Hiding, ChangesNoPixel) {
  std::mt19937_64 random = seeded_random(73);
  // A long floor that begins near the camera is drawn first; little of it hides what is on it.
  Scene scene;
  const Isometry3d floor = at(0, 0, 1.5) * AngleAxisd(0.7, Vector3d::UnitX());
  scene.add(box({2.0F, 0.01F, 2.5F}), floor);
  for (int i = 0; i < 8; ++i) {
    scene.add(cut_above(sphere(0.02F + 0.005F * float(i), 40), 0.0F), floor);  // both sides show
    scene.add(sphere(0.05F, 40), floor);
  }
  const auto behind = at(0, 0, -5);
  for (const std::string& isa : simd_target_names()) {
    const auto renderer = make({Backend::cpu, isa, 1}, camera, scene.bodies());
    for (int round = 0; round < 20; ++round) {
      auto poses = scene.poses;
      for (std::size_t i = 1; i < poses.size(); ++i)
        poses[i] = floor * random_pose(random, {-0.3, -0.1, -1.0}, {0.3, 0.05, 1.0});
      Image<float> depth(camera.width(), camera.height(), 0.0F);
      Image<std::uint16_t> links(camera.width(), camera.height(), 0);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        std::vector<Isometry3d> alone(poses.size(), behind);
        alone[i] = poses[i];
        const VirtualDepthView drawn = renderer->render(alone);
        for (const auto [u, v] : each_pixel(camera)) {
          const float z = drawn.depth(u, v);
          // Of equal depths the last body counts.
          if (z == 0.0F || (depth(u, v) > 0.0F && z > depth(u, v))) continue;
          depth(u, v) = z;
          links(u, v) = drawn.links(u, v);
        }
      }
      expect_same_bits(renderer->render(poses), {depth.view(), links.view()});
    }
  }
}

TEST(Threads, RenderersSideBySideDoNotDisturbEachOther) {
  const Scene scene = crowded_scene();
  const auto alone = make({Backend::cpu, "", 1}, camera, scene.bodies());
  const Frame expected(alone->render(scene.poses));
  const auto work = [&](const BackendChoice& choice) {
    const auto renderer = make(choice, camera, scene.bodies());
    for (int i = 0; i < 10; ++i) expect_same_bits(renderer->render(scene.poses), expected.view());
  };
  std::thread one(work, BackendChoice{Backend::cpu, "", 1});
  std::thread two(work, BackendChoice{Backend::cpu, "", 2});
  one.join();
  two.join();
}

}  // namespace
}  // namespace penumbra::test
