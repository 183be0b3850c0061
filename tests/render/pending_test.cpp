// SPDX-License-Identifier: Apache-2.0
// Frames taken ahead, and the memory of frame loops.
#include "allocations.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

namespace penumbra::test {
namespace {

class Pending : public RenderTest {
 protected:
  Pending() {
    for (int i = 0; i < 4; ++i) scene_.add(sphere(0.1F, 12));
    scene_.add(box({0.2F, 0.05F, 0.1F}));
  }

  /// One set of poses in seven is behind the camera, and one reaches through it.
  [[nodiscard]] std::vector<std::vector<Isometry3d>> random_frames(std::size_t count) {
    std::mt19937_64 random = seeded_random(85);
    std::vector<std::vector<Isometry3d>> frames(count, scene_.poses);
    for (std::size_t i = 0; i < count; ++i) {
      const double nearest = i % 7 == 3 ? -3.0 : i % 7 == 5 ? -0.3 : 0.6;
      for (auto& pose : frames[i])
        pose = random_pose(random, {-0.6, -0.4, nearest}, {0.6, 0.4, nearest + 1.0});
    }
    return frames;
  }

  Scene scene_;
};
PENUMBRA_FOR_EACH_BACKEND(Pending, 2);

const Intrinsics pending_camera(233, 157, 200.0, 205.0, 120.3, 70.9);

TEST_P(Pending, FramesComeInOrderAndAsFromRender) {
  const auto frames = random_frames(20);
  const auto plain = make(GetParam(), pending_camera, scene_.bodies());
  std::vector<Frame> expected;
  expected.reserve(frames.size());
  for (const auto& poses : frames) expected.emplace_back(plain->render(poses));
  const auto ahead = make(GetParam(), pending_camera, scene_.bodies());
  for (int depth = 1; depth <= ahead->max_pending(); ++depth) {
    std::size_t collected = 0;
    const auto collect = [&] {
      const VirtualDepthView view = ahead->collect();
      expect_consistent(view, pending_camera, scene_.poses.size());
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

TEST_P(Pending, ViewsStayValidForMaxPendingFrames) {
  const auto frames = random_frames(10);
  const auto renderer = make(GetParam(), pending_camera, scene_.bodies());
  std::deque<std::pair<VirtualDepthView, Frame>> valid;
  for (const auto& poses : frames) {
    if (int(valid.size()) == renderer->max_pending()) valid.pop_front();
    const VirtualDepthView view = renderer->render(poses);
    valid.emplace_back(view, Frame(view));
    for (const auto& [seen, copy] : valid) expect_same_bits(seen, copy.view());
  }
}

TEST_P(Pending, MisuseIsALogicError) {
  const auto renderer = make(GetParam(), pending_camera, scene_.bodies());
  const auto poses = random_frames(1).front();
  EXPECT_THROW((void)renderer->collect(), std::logic_error);
  for (int i = 0; i < renderer->max_pending(); ++i) renderer->submit(poses);
  EXPECT_THROW(renderer->submit(poses), std::logic_error);
  EXPECT_THROW((void)renderer->render(poses), std::logic_error);
  EXPECT_EQ(renderer->pending(), renderer->max_pending());
  while (renderer->pending() > 0) (void)renderer->collect();
  EXPECT_THROW((void)renderer->collect(), std::logic_error);
  EXPECT_GT(Frame(renderer->render(poses)).covered(), 0U);
}

PENUMBRA_RENDER_TEST(Allocation, 4);

TEST_P(Allocation, NoneInTheFrameLoop) {
  const Intrinsics intrinsics(320, 240, 300.0, 300.0, 160.0, 120.0);
  std::mt19937_64 random = seeded_random(81);
  Scene scene;
  for (int i = 0; i < 6; ++i) {
    scene.add(sphere(0.1F, 24));
    scene.add(triangle_soup(random, 5, 0.5F));
  }
  // Many poses, the worst of them (everything through the camera, everything large) not the first.
  std::vector<std::vector<Isometry3d>> frames(30, scene.poses);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double nearest = i < 10 ? 2.0 : -0.2;
    for (auto& pose : frames[i])
      pose = random_pose(random, {-0.5, -0.4, nearest}, {0.5, 0.4, nearest + 1.0});
  }
  const auto renderer = make(GetParam(), intrinsics, scene.bodies());
  (void)renderer->render(frames[0]);
  (void)renderer->render(frames[1]);
  if (GetParam().backend == Backend::gl) {
    // OpenGL's driver compiles for each state that it meets for the first time.
    for (const auto& poses : frames) (void)renderer->render(poses);
  }
  const std::size_t before = allocations();
  for (const auto& poses : frames) (void)renderer->render(poses);
  EXPECT_EQ(allocations() - before, 0U);
}

}  // namespace
}  // namespace penumbra::test
