// SPDX-License-Identifier: Apache-2.0
// What only the OpenGL renderer has: devices, contexts, the rectangle that it reads back.
#include "render_test.hpp"
#include "shapes.hpp"

#include <thread>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/gl/egl_context.hpp>
#include <penumbra/render/gl/gl_calls.hpp>

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

TEST_F(Gl, DevicesThatDoNotExistAreRefused) {
  const std::size_t count = gl_devices().size();
  const auto made_with = [&](int device) {
    return [=] { (void)make_depth_renderer(Backend::gl, camera, {}, {.gl_device = device}); };
  };
  expect_refused(made_with(int(count)), {"no device " + std::to_string(count)});
  expect_refused(made_with(-2), {"-2"});
}

TEST_F(Gl, RectanglesLeaveNothingOut) {
  std::mt19937_64 random = seeded_random(92);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::size_t tight = 0;
  for (int round = 0; round < 500; ++round) {
    const Eigen::AlignedBox3d bounds(Vector3d(-0.1, -0.2 * unit(random), -0.1),
                                     Vector3d(0.1, 0.1, 0.3 * unit(random)));
    const Isometry3d pose = random_pose(random, {-1, -1, -0.4}, {1, 1, 1.5});
    const PixelRectangle seen = pixels_of(bounds, pose, camera);
    tight += seen.width() < camera.width() ? 1 : 0;
    for (int i = 0; i < 200; ++i) {
      const double x = unit(random), y = unit(random);
      const Vector3d share(x, y, unit(random));
      const Vector3d p = pose * (bounds.min() + share.cwiseProduct(bounds.sizes()));
      if (p.z() < DepthRenderer::near_plane) continue;
      const Vector2d pixel = camera.project(p).array().round();
      const bool in_image = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < camera.width() &&
                            pixel.y() < camera.height();
      if (!in_image) continue;
      EXPECT_TRUE(pixel.x() >= seen.u0 && pixel.x() < seen.u1 && pixel.y() >= seen.v0 &&
                  pixel.y() < seen.v1)
          << "round " << round;
    }
  }
  EXPECT_GT(tight, 250U);
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
