// SPDX-License-Identifier: Apache-2.0
#include "allocations.hpp"
#include "errors.hpp"
#include "random.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

#include <random>

namespace penumbra::test {
namespace {

class Allocation : public RenderTest {};
PENUMBRA_FOR_EACH_BACKEND(Allocation, 4);

TEST_P(Allocation, NoneInTheFrameLoop) {
  const Intrinsics camera(320, 240, 300.0, 300.0, 160.0, 120.0);
  std::mt19937_64 random = seeded_random(81);
  Scene scene;
  for (int i = 0; i < 6; ++i) {
    scene.add(sphere(0.1F, 24));
    scene.add(triangle_soup(random, 5, 0.5F));
  }
  // Many poses, the worst of them (everything through the camera, everything large) not the first.
  std::vector<std::vector<Eigen::Isometry3d>> frames(30, scene.poses);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double nearest = i < 10 ? 2.0 : -0.2;
    for (auto& pose : frames[i]) {
      pose = random_pose(random, {-0.5, -0.4, nearest}, {0.5, 0.4, nearest + 1.0});
    }
  }
  const auto renderer = make(GetParam(), camera, scene.bodies());
  static_cast<void>(renderer->render(frames[0]));
  static_cast<void>(renderer->render(frames[1]));
  if (GetParam().backend == Backend::gl) {
    // OpenGL's driver compiles for each state that it meets for the first time.
    for (const auto& poses : frames) static_cast<void>(renderer->render(poses));
  }
  const std::size_t before = allocations();
  for (const auto& poses : frames) static_cast<void>(renderer->render(poses));
  EXPECT_EQ(allocations() - before, 0U);
}

}  // namespace
}  // namespace penumbra::test
