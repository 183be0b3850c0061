// SPDX-License-Identifier: Apache-2.0
// What only the OpenGL renderer has: devices and contexts.
#include "render_test.hpp"
#include "shapes.hpp"

#include <thread>

namespace penumbra::test {
namespace {

const Intrinsics camera(320, 240, 300.0, 300.0, 160.0, 120.0);

class Gl : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
    std::mt19937_64 random = seeded_random(91);
    for (int i = 0; i < 8; ++i) {
      scene_.add(sphere(0.1F, 16), random_pose(random, {-0.4, -0.3, 0.6}, {0.4, 0.3, 1.5}));
      scene_.add(triangle_soup(random, 3, 0.3F), at(0, 0, 0.6));
    }
  }

  Scene scene_;
};

TEST_F(Gl, DevicesTellTheirNames) {
  const std::vector<GlDevice> devices = gl_devices();
  ASSERT_FALSE(devices.empty());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const GlDevice& device = devices[i];
    if (!device.fault.empty()) continue;
    EXPECT_FALSE(device.name.empty());
    EXPECT_FALSE(device.vendor.empty());
    EXPECT_EQ(device.software, device.name.find("llvmpipe") != std::string::npos) << device.name;
    const auto renderer =
        make_depth_renderer(Backend::gl, camera, scene_.bodies(), {.gl_device = int(i)});
    EXPECT_EQ(renderer->info().device, device.name + ", OpenGL " + device.version);
    EXPECT_EQ(renderer->info().backend, Backend::gl);
    EXPECT_GT(Frame(renderer->render(scene_.poses)).covered(), 0U);
  }
}

TEST_F(Gl, RenderersServeManyThreads) {
  const auto alone = make(opengl, camera, scene_.bodies());
  const Frame expected(alone->render(scene_.poses));
  const auto work = [&] {
    for (int made = 0; made < 2; ++made) {
      const auto one = make(opengl, camera, scene_.bodies());
      const auto two = make(opengl, camera, scene_.bodies());
      for (int i = 0; i < 10; ++i) {
        one->submit(scene_.poses);
        two->submit(scene_.poses);
        expect_same_bits(two->collect(), expected.view());
        expect_same_bits(one->collect(), expected.view());
      }
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 4; ++i) {  // one moves between threads
    std::thread([&] { alone->submit(scene_.poses); }).join();
    std::thread([&] { expect_same_bits(alone->collect(), expected.view()); }).join();
  }
}

}  // namespace
}  // namespace penumbra::test
