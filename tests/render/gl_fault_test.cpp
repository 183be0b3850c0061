// SPDX-License-Identifier: Apache-2.0
// A graphics device that fails: no spoilt frame may come, nor one in another's place.
#include "gl_faults.hpp"
#include "random.hpp"
#include "render_test.hpp"
#include "shapes.hpp"

#include <random>
#include <stdexcept>

#include <penumbra/base/error.hpp>
#include <penumbra/render/gl/gl_devices.hpp>

namespace penumbra::test {
namespace {

class GlFaults : public ::testing::Test {
 protected:
  using Poses = std::vector<Eigen::Isometry3d>;

  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << no_opengl;
    scene_.add(sphere(0.2F, 12));
    std::mt19937_64 random = seeded_random(95);
    const auto renderer = make(opengl, odd_camera, scene_.bodies());
    for (int i = 0; i < renderer->max_pending(); ++i) {
      poses_.push_back({random_pose(random, {-0.2, -0.2, 0.6}, {0.2, 0.2, 1.2})});
      frames_.emplace_back(renderer->render(poses_.back()));
    }
  }

  /// Draws all frames ahead with a device that fails; whether it came to that.
  [[nodiscard]] bool fails_once(GlFault fault, int spared) const {
    const auto renderer = make(opengl, odd_camera, scene_.bodies());
    const InjectedFault injected(fault, spared);
    Attempts attempt;
    for (const Poses& poses : poses_) attempt([&] { renderer->submit(poses); });
    for (std::size_t i = 0; renderer->pending() > 0; ++i) {
      attempt([&] { expect_same_bits(renderer->collect(), frames_[i].view()); });
    }
    for (const Poses& poses : poses_) attempt([&] { renderer->submit(poses); });
    EXPECT_EQ(attempt.failed(), injected.happened());
    return attempt.failed();
  }

  Scene scene_;
  std::vector<Poses> poses_;
  std::vector<Frame> frames_;
};

TEST_F(GlFaults, LetARendererFailForGood) {
  for (const GlFault fault : all_gl_faults) {
    SCOPED_TRACE(to_string(fault));
    int spared = 0;
    while (fails_once(fault, spared)) ++spared;
    EXPECT_GE(spared, static_cast<int>(frames_.size()));
    const auto renderer = make(opengl, odd_camera, scene_.bodies());
    expect_same_bits(renderer->render(poses_[0]), frames_[0].view());
  }
}

TEST_F(GlFaults, WithoutAnythingToSeeAreToldToo) {
  const auto renderer = make(opengl, odd_camera, scene_.bodies());
  const Poses behind{at(0, 0, -1)};
  EXPECT_EQ(Frame(renderer->render(behind)).covered(), 0U);
  renderer->submit(behind);
  const InjectedFault lost(GlFault::reset);
  EXPECT_THROW(static_cast<void>(renderer->collect()), DeviceError);
  EXPECT_THROW(renderer->submit(behind), DeviceError);
}

TEST_F(GlFaults, OfOneDeviceDoNotHideTheOthers) {
  const std::vector<GlDevice> usable = gl_devices();
  {
    const NoDeviceCurrent none;
    const std::vector<GlDevice> devices = gl_devices();
    ASSERT_EQ(devices.size(), usable.size());
    for (const GlDevice& device : devices) {
      EXPECT_NE(device.fault.find("renderer 'gl': "), std::string::npos) << device.fault;
    }
    EXPECT_THROW(static_cast<void>(make(opengl, odd_camera, scene_.bodies())), InputError);
  }
  if (usable.size() < 2) return;
  const InjectedFault first(GlFault::make_current);
  const std::vector<GlDevice> devices = gl_devices();
  EXPECT_NE(devices[0].fault, "");
  EXPECT_EQ(devices[1].fault, usable[1].fault);
}

}  // namespace
}  // namespace penumbra::test
