// SPDX-License-Identifier: Apache-2.0
// What only the OpenGL renderer has: devices, contexts, the rectangle that it reads back.
#include "random.hpp"
#include "render_test.hpp"
#include "run_length.hpp"
#include "shapes.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include <unistd.h>

#include <penumbra/base/error.hpp>
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

/// The message with which a renderer is refused; it must be one line.
std::string refusal(const Intrinsics& intrinsics, int device) {
  try {
    static_cast<void>(make_depth_renderer(Backend::gl, intrinsics, {}, {.gl_device = device}));
    return "";
  } catch (const InputError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
}

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
  const std::string message = refusal(camera, static_cast<int>(count));
  EXPECT_NE(message.find("no device " + std::to_string(count)), std::string::npos) << message;
  EXPECT_NE(message.find("EGL offers " + std::to_string(count)), std::string::npos) << message;
  EXPECT_NE(refusal(camera, -2), "");
}

TEST_F(Gl, LargestImagesAreDrawnOrRefused) {
  EXPECT_THROW(Intrinsics(100000, 100000, 1e5, 1e5, 5e4, 5e4), InputError);
  const Intrinsics wide(Intrinsics::max_size, 3, 1e4, 1e4, 1e4, 1.0);
  const std::string message = refusal(wide, -1);
  if (message.empty()) return;
  EXPECT_NE(message.find("32767 x 3"), std::string::npos) << message;
}

TEST_F(Gl, WhatIsLargerThanTheDeviceTakesIsRefused) {
  const auto context = gl::open_device(-1);
  const gl::EglContext::Current current(*context);
  constexpr std::size_t petabyte = std::size_t{1} << 50;
  try {
    gl::make_buffer(petabyte, nullptr, 0, "the meshes");
    FAIL() << context->device().name << " gave a petabyte";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("1125899907 MB for the meshes"), std::string::npos) << message;
    EXPECT_NE(message.find(context->device().name), std::string::npos) << message;
  }
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

/// What this process holds of the system.
struct Holdings {
  std::size_t files = 0;
  std::size_t resident = 0;  // bytes

  static Holdings now() {
    Holdings held;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
      ++held.files;
    std::ifstream pages("/proc/self/statm");
    std::size_t all = 0;
    pages >> all >> held.resident;
    held.resident *= static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return held;
  }
};

/// Bytes by which memory may grow for each renderer made and dropped, and for each frame: malloc's
/// own unrest, some 2 MB, over the shortest run. A lost image would show as 460 kB each time.
constexpr std::size_t growth_per_cycle = 40'000;
constexpr std::size_t growth_per_frame = 1'000;
/// Bytes for the long runs of PENUMBRA_FULL: over 1000 cycles a lost mesh would show as 20 MB.
constexpr std::size_t growth_in_all = 2'000'000;

/// How often to do what PENUMBRA_FULL does `full` times.
int repeats(int usual, int full) {
  if (sanitized) return usual / 10;
  return is_full_run() ? full : usual;
}

template <typename Step>
void expect_no_growth(int count, std::size_t growth, Step&& step) {
  for (int i = 0; i < count / 3; ++i) step();
  const Holdings before = Holdings::now();
  for (int i = 0; i < count; ++i) step();
  const Holdings after = Holdings::now();
  std::cout << count << " times: files " << before.files << " -> " << after.files << ", resident "
            << before.resident / 1000 << " -> " << after.resident / 1000 << " kB\n";
  EXPECT_EQ(after.files, before.files);
  if (!sanitized) {  // their allocators keep what is freed; LeakSanitizer looks for what is not
    const std::size_t most =
        is_full_run() ? growth_in_all : growth * static_cast<std::size_t>(count);
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
