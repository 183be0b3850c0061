// SPDX-License-Identifier: Apache-2.0
// What only the OpenGL renderer has: devices, contexts, the rectangle that it reads back.
#include "errors.hpp"
#include "process_memory.hpp"
#include "random.hpp"
#include "render_test.hpp"
#include "run_length.hpp"
#include "shapes.hpp"

#include <random>
#include <thread>

#include <penumbra/render/gl/buffer.hpp>
#include <penumbra/render/gl/gl_devices.hpp>
#include <penumbra/render/gl/open_device.hpp>
#include <penumbra/render/gl/pixel_rectangle.hpp>

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
    const auto renderer = make_depth_renderer(Backend::gl, camera, scene_.bodies(),
                                              {.gl_device = static_cast<int>(i)});
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
  expect_refused(made_with(static_cast<int>(count)), {"no device " + std::to_string(count)});
  expect_refused(made_with(-2), {"-2"});
}

TEST_F(Gl, WhatIsLargerThanTheDeviceTakesIsRefused) {
  const auto context = gl::open_device(-1);
  const gl::EglContext::Current current(*context);
  constexpr std::size_t petabyte = std::size_t{1} << 50;
  expect_refused([&] { gl::make_buffer(petabyte, nullptr, 0, "the meshes"); },
                 {"1125899907 MB for the meshes", context->device().name});
}

TEST_F(Gl, OnlyTheRobotsRectangleIsTouched) {
  Scene small;
  small.add(box({0.05F, 0.05F, 0.05F}), at(0.3, 0.2, 1.0));
  const auto renderer = make(opengl, camera, small.bodies());
  const VirtualDepthView view = renderer->render(small.poses);
  expect_consistent(view, camera, 1);
  std::size_t pixels = 0;
  view.touched->for_each_span([&](int u0, int u1, int v0, int v1) {
    pixels += static_cast<std::size_t>(u1 - u0) * static_cast<std::size_t>(v1 - v0);
  });
  EXPECT_GT(Frame(view).covered(), 800U);
  EXPECT_LT(pixels, 8000U);  // of 76800
}

TEST_F(Gl, RectanglesLeaveNothingOut) {
  std::mt19937_64 random = seeded_random(92);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::size_t tight = 0;
  for (int round = 0; round < 500; ++round) {
    const Eigen::AlignedBox3d bounds(Eigen::Vector3d(-0.1, -0.2 * unit(random), -0.1),
                                     Eigen::Vector3d(0.1, 0.1, 0.3 * unit(random)));
    const Eigen::Isometry3d pose = random_pose(random, {-1, -1, -0.4}, {1, 1, 1.5});
    const gl::PixelRectangle seen = gl::pixels_of(bounds, pose, camera);
    tight += seen.width() < camera.width() ? 1 : 0;
    for (int i = 0; i < 200; ++i) {
      const double x = unit(random);
      const double y = unit(random);
      const Eigen::Vector3d share(x, y, unit(random));
      const Eigen::Vector3d p = pose * (bounds.min() + share.cwiseProduct(bounds.sizes()));
      if (p.z() < DepthRenderer::near_plane) continue;
      const Eigen::Vector2d pixel = camera.project(p).array().round();
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

TEST_F(Gl, RenderersInManyThreadsDoNotDisturbEachOther) {
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
  expect_same_bits(alone->render(scene_.poses), expected.view());
}

TEST_F(Gl, RenderersMoveBetweenThreads) {
  const auto renderer = make(opengl, camera, scene_.bodies());
  const Frame expected(renderer->render(scene_.poses));
  for (int i = 0; i < 4; ++i) {
    std::thread([&] { renderer->submit(scene_.poses); }).join();
    std::thread([&] { expect_same_bits(renderer->collect(), expected.view()); }).join();
  }
}

/// MiB by which memory may grow for each renderer made and dropped, and for each frame: malloc's
/// own changes, some 2 MB, over the shortest run. A lost image would show as 0.4 MiB each time.
constexpr double growth_per_cycle = 0.04;
constexpr double growth_per_frame = 0.001;
/// MiB for the long runs of PENUMBRA_FULL: over 1000 cycles a lost mesh would show as 20 MiB.
constexpr double growth_in_all = 2.0;

/// How often to do what PENUMBRA_FULL does `full` times.
int repeats(int usual, int full) {
  if (sanitized) return usual / 10;
  return is_full_run() ? full : usual;
}

template <typename Step>
void expect_no_growth(int count, double growth, Step&& step) {
  for (int i = 0; i < count / 3; ++i) step();
  const ProcessMemory before = memory_of();
  for (int i = 0; i < count; ++i) step();
  const ProcessMemory after = memory_of();
  std::cout << count << " times: resident " << before.resident << " -> " << after.resident
            << " MiB\n";
  EXPECT_EQ(after.open_files, before.open_files);
  if (!sanitized) {  // their allocators keep what is freed; LeakSanitizer looks for what is not
    const double most = is_full_run() ? growth_in_all : growth * count;
    EXPECT_LT(after.resident, before.resident + most);
  }
}

TEST_F(Gl, RenderersMadeAndDroppedHoldNothing) {
  expect_no_growth(repeats(100, 1000), growth_per_cycle, [&] {
    const auto renderer = make(opengl, camera, scene_.bodies());
    static_cast<void>(renderer->render(scene_.poses));
  });
}

TEST_F(Gl, FramesHoldNothing) {
  const auto renderer = make(opengl, camera, scene_.bodies());
  expect_no_growth(repeats(300, 10000), growth_per_frame,
                   [&] { static_cast<void>(renderer->render(scene_.poses)); });
}

}  // namespace
}  // namespace penumbra::test
