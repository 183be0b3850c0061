// SPDX-License-Identifier: Apache-2.0
// Which renderer is the faster one, and what is said where OpenGL is of no use.
#include "render_test.hpp"
#include "shapes.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

#include <penumbra/base/error.hpp>
#include <penumbra/base/simd_target.hpp>
#include <penumbra/render/gl/gl_devices.hpp>
#include <penumbra/render/renderer_choice.hpp>
#include <penumbra/render/renderer_race-inl.hpp>

namespace penumbra::test {
namespace {

using namespace std::chrono_literals;

const Intrinsics camera(320, 240, 300.0, 300.0, 170.0, 100.0);
constexpr auto clearly_slower = 5ms;  // beside frames of less than 0.1 ms

Scene arm() {
  Scene scene;
  for (int i = 0; i < 3; ++i) scene.add(sphere(0.1F, 12));
  scene.add(std::vector<TriangleMesh>{});  // a link that is not drawn
  scene.add(box({0.2F, 0.05F, 0.1F}));
  return scene;
}

/// Stands for a renderer on another device: the cpu's images, as they are made of them.
class StandIn : public DepthRenderer {
 public:
  using Change = std::function<void(Frame&)>;

  StandIn(RendererInfo info, const std::vector<Body>& bodies, std::chrono::milliseconds delay,
          Change change = {})
      : DepthRenderer(camera, bodies, std::move(info)),
        inner_(make_depth_renderer(Backend::cpu, camera, bodies)),
        delay_(delay),
        change_(std::move(change)) {}

  /// Poses of every frame, in the order they came.
  std::vector<std::vector<Eigen::Isometry3d>> seen;

 private:
  void do_submit(std::span<const Eigen::Isometry3d> T_camera_body) override {
    std::this_thread::sleep_for(delay_);
    seen.emplace_back(T_camera_body.begin(), T_camera_body.end());
    inner_->submit(T_camera_body);
  }
  VirtualDepthView do_collect() override {
    frame_.emplace(inner_->collect());
    if (change_) change_(*frame_);
    return frame_->view();
  }

  std::unique_ptr<DepthRenderer> inner_;
  std::chrono::milliseconds delay_;
  Change change_;
  std::optional<Frame> frame_;
};

const RendererInfo cpu_info{Backend::cpu, "FAST", 1, ""};
const RendererInfo gl_info{Backend::gl, "", 1, "Some GPU, OpenGL 4.6"};

void expect_holds(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

TEST(RendererRace, TheFasterOneWinsAndBothFiguresAreTold) {
  const Scene scene = arm();
  for (const bool gl_is_slow : {false, true}) {
    StandIn cpu(cpu_info, scene.bodies(), gl_is_slow ? 0ms : clearly_slower);
    StandIn gl(gl_info, scene.bodies(), gl_is_slow ? clearly_slower : 0ms);
    const RendererChoice choice = race(cpu, gl, scene.bodies());
    EXPECT_EQ(choice.backend, gl_is_slow ? Backend::cpu : Backend::gl) << choice.reason;
    expect_holds(choice.reason, {"gl on Some GPU, OpenGL 4.6", "cpu on FAST", " ms ("});
    EXPECT_EQ(choice.reason.find('\n'), std::string::npos);
    EXPECT_TRUE(choice.warnings.empty());
  }
}

TEST(RendererRace, BodiesMoveInEveryFrameAndAreAllSeen) {
  const Scene scene = arm();
  std::set<int> links;
  const auto look = [&](Frame& frame) {
    for (std::size_t i = 0; i < frame.links.size(); ++i) links.insert(frame.links.data()[i]);
  };
  StandIn cpu(cpu_info, scene.bodies(), 0ms);
  StandIn gl(gl_info, scene.bodies(), 0ms, look);
  static_cast<void>(race(cpu, gl, scene.bodies()));
  EXPECT_EQ(links, (std::set<int>{0, 1, 2, 3, 5})) << "the fourth has nothing to draw";
  const auto move = [](const auto& a, const auto& b) { return !a[0].isApprox(b[0]); };
  ASSERT_GT(gl.seen.size(), 4U);
  std::size_t moves = 0;
  for (std::size_t i = 1; i < gl.seen.size(); ++i) moves += move(gl.seen[i - 1], gl.seen[i]);
  EXPECT_EQ(moves, gl.seen.size() - 1);
}

TEST(RendererRace, AnImageThatIsNotTheCpusIsAFault) {
  const Scene scene = arm();
  const std::vector<StandIn::Change> changes = {
      [](Frame& frame) { frame.depth = Image<float>(camera.width(), camera.height()); },
      [](Frame& frame) {
        for (std::size_t i = 0; i < frame.depth.size(); ++i) frame.depth.data()[i] *= 1.01F;
      },
      [](Frame& frame) {
        std::reverse(frame.depth.data(), frame.depth.data() + frame.depth.size());
      },
      [](Frame& frame) {
        std::replace(frame.links.data(), frame.links.data() + frame.links.size(), std::uint16_t{5},
                     std::uint16_t{1});
      }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    StandIn cpu(cpu_info, scene.bodies(), clearly_slower);
    StandIn gl(gl_info, scene.bodies(), 0ms, changes[i]);
    try {
      const RendererChoice choice = race(cpu, gl, scene.bodies());
      ADD_FAILURE() << "change " << i << ": " << choice.reason;
    } catch (const std::runtime_error& error) {
      expect_holds(error.what(), {"Some GPU", "driver"});
    }
  }
}

TEST(RendererRace, NothingToDrawIsNoFault) {
  const std::vector<Body> none;
  StandIn cpu(cpu_info, none, 0ms), gl(gl_info, none, clearly_slower);
  EXPECT_EQ(race(cpu, gl, none).backend, Backend::cpu);
}

/// This machine's devices; nothing, with `fault` said, where there is no OpenGL.
std::vector<GlDevice> devices_here(std::string& fault) {
  try {
    return gl_devices();
  } catch (const InputError& error) {
    fault = error.what();
    static_cast<void>(is_there(false, "opengl"));
    return {};
  }
}

TEST(RendererChoice, IsWhatThisMachineOffers) {
  std::string fault;
  const std::vector<GlDevice> devices = devices_here(fault);
  const auto is_gpu = [](const GlDevice& device) {
    return device.fault.empty() && !device.software;
  };
  const Scene scene = arm();
  const RendererChoice choice = choose_backend(camera, scene.bodies());
  ASSERT_FALSE(choice.reason.empty());
  if (!fault.empty()) {
    ASSERT_EQ(choice.warnings.size(), 1U);
    expect_holds(choice.warnings[0], {fault});
  }
  if (std::none_of(devices.begin(), devices.end(), is_gpu)) {
    EXPECT_EQ(choice.backend, Backend::cpu);
    EXPECT_EQ(choice.reason.find(" ms ("), std::string::npos) << "software is not measured";
  } else if (choice.warnings.empty()) {
    expect_holds(choice.reason, {" ms (", "gl on ", "cpu on " + simd_target_names().front()});
  }
}

TEST(RendererChoice, RendererIsTheOneChosen) {
  const Scene scene = arm();
  std::string fault;
  const auto devices = static_cast<int>(devices_here(fault).size());
  for (int device = -1; device < devices; ++device) {
    RendererOptions options;
    options.gl_device = device;
    const ChosenRenderer chosen = make_fastest_renderer(camera, scene.bodies(), options);
    EXPECT_EQ(chosen.renderer->info().backend, chosen.choice.backend);
    EXPECT_EQ(chosen.renderer->intrinsics(), camera);
    EXPECT_EQ(chosen.renderer->pending(), 0);
    std::cout << "device " << device << ": " << to_string(chosen.choice.backend) << ": "
              << chosen.choice.reason << '\n';
  }
}

TEST(RendererChoice, ADeviceThatIsNotThereIsTheUsersFault) {
  std::string fault;
  const std::vector<GlDevice> devices = devices_here(fault);
  if (!fault.empty()) GTEST_SKIP() << fault;
  for (const int device : {-2, static_cast<int>(devices.size()), 1000}) {
    RendererOptions options;
    options.gl_device = device;
    EXPECT_THROW(static_cast<void>(choose_backend(camera, arm().bodies(), options)), InputError)
        << device;
  }
}

TEST(RendererChoice, WhatTheCpuBackendRefusesIsRefused) {
  RendererOptions options;
  options.isa = "MMX";
  EXPECT_THROW(static_cast<void>(choose_backend(camera, arm().bodies(), options)), InputError);
}

}  // namespace
}  // namespace penumbra::test
