// SPDX-License-Identifier: Apache-2.0
#include "../support/errors.hpp"
#include "../support/opengl.hpp"
#include "slab_scene.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// The scene with something of each kind done to it, and the labels that must come of it.
struct EditedScene {
  Image<float> depth;
  Image<std::uint8_t> labels;
};

EditedScene edited_scene(const Camera& camera, double slide) {
  const Intrinsics& k = camera.intrinsics;
  EditedScene scene{scene_depth(camera, slide), Image<std::uint8_t>(k.width(), k.height())};
  const float changes[] = {0.0F, -0.3F, -0.021F, -0.019F, 0.039F, 0.041F, 0.8F};
  const Label labels[] = {Label::occluded, Label::front,  Label::front, Label::occluded,
                          Label::occluded, Label::beyond, Label::beyond};
  for (int v = 0; v < k.height(); ++v) {
    for (int u = 0; u < k.width(); ++u) {
      const bool robot = cast(k.ray(u, v), slide).depth > 0.0;
      const int kind = u / 3 % 8;
      scene.depth(u, v) = kind < 7 ? scene.depth(u, v) + changes[kind] : 0.0F;
      const Label label = kind < 7 ? labels[kind] : Label::unknown;
      scene.labels(u, v) = static_cast<std::uint8_t>(robot ? label : Label::clear);
    }
  }
  return scene;
}

class PipelineOf : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (!can_draw(GetParam())) GTEST_SKIP() << no_opengl;
  }
};
INSTANTIATE_TEST_SUITE_P(Backends, PipelineOf,
                         testing::Values(Backend::cpu, Backend::gl, Backend::reference),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_P(PipelineOf, DrawsWhatTheFormulaTells) {
  const Camera camera = slab_camera();
  Pipeline pipeline(slab_robot(), camera, plain_config(GetParam()));
  for (const double slide : {0.0, 0.317, -0.25}) {
    const std::vector<double> positions = {slide};
    const FrameReport& report = pipeline.process({.pose = {.positions = positions}});
    ASSERT_EQ(report.virtual_depth.depth.width, camera.intrinsics.width());
    std::size_t robot = 0;
    for (int v = 0; v < camera.intrinsics.height(); ++v) {
      for (int u = 0; u < camera.intrinsics.width(); ++u) {
        const Seen seen = cast(camera.intrinsics.ray(u, v), slide);
        robot += seen.depth > 0.0 ? 1 : 0;
        ASSERT_NEAR(report.virtual_depth.depth(u, v), seen.depth, depth_tolerance)
            << u << ',' << v << " slide " << slide;
        ASSERT_EQ(report.virtual_depth.links(u, v), seen.link) << u << ',' << v;
      }
    }
    EXPECT_GT(robot, 500U);
    EXPECT_EQ(report.pixels.robot, robot);
  }
}

TEST_P(PipelineOf, LabelsEveryPixelAsTheRuleSays) {
  const Camera camera = slab_camera();
  const EditedScene scene = edited_scene(camera, 0.1);
  const Image<std::uint16_t> millimetres = to_millimetres(scene.depth);
  const std::vector<double> positions = {0.1};
  Pipeline pipeline(slab_robot(), camera, plain_config(GetParam()));
  for (const DepthView& depth :
       {DepthView(scene.depth.view()), DepthView(std::as_const(millimetres).view())}) {
    const FrameReport& report =
        pipeline.process({.stamp = 7, .depth = depth, .pose = {.positions = positions}});
    EXPECT_EQ(report.status, FrameStatus::ok) << report.message;
    EXPECT_EQ(report.stamp, 7);
    EXPECT_FALSE(report.joint_age.has_value());
    EXPECT_EQ(pixels_of(report.labels), pixels_of(scene.labels.view()));
    std::size_t counts[label_count] = {};
    for (const std::uint8_t label : pixels_of(scene.labels.view())) ++counts[label];
    EXPECT_EQ(report.pixels.front, counts[1]);
    EXPECT_EQ(report.pixels.occluded, counts[2]);
    EXPECT_EQ(report.pixels.unknown, counts[3]);
    EXPECT_EQ(report.pixels.beyond, counts[4]);
    EXPECT_EQ(report.pixels.uncovered, 0U);
    EXPECT_EQ(report.pixels.robot, counts[1] + counts[2] + counts[3] + counts[4]);
  }
}

TEST(Pipeline, TakesTheCameraOnAMovingLink) {
  PipelineConfig config = plain_config();
  config.camera_parent = "slab";
  config.T_parent_camera.translation() = Eigen::Vector3d(0.0, 0.0, -1.0);
  Pipeline pipeline(slab_robot(), slab_camera(), config);
  for (const double slide : {0.0, 0.2}) {
    const std::vector<double> positions = {slide};
    const FrameReport& report = pipeline.process({.pose = {.positions = positions}});
    EXPECT_NEAR(report.virtual_depth.depth(73, 57), slab_depth, depth_tolerance);
    EXPECT_NEAR(report.virtual_depth.depth(73 + 40, 57 + 8), 1.45 - slide, depth_tolerance);
  }
}

TEST(Pipeline, BothRangesLimitWhatIsMeasured) {
  Camera camera = slab_camera();
  camera.range = {0.5, 0.96};
  PipelineConfig config = plain_config();
  config.rule.range = {0.2, 10.0};
  Pipeline pipeline(slab_robot(), camera, config);
  const std::vector<double> positions = {0.0};
  const Image<float> depth = scene_depth(camera, 0.0);
  const FrameReport& report =
      pipeline.process({.depth = depth.view(), .pose = {.positions = positions}});
  EXPECT_GT(report.pixels.occluded, 0U) << "the slab at 0.95 m";
  EXPECT_GT(report.pixels.unknown, 0U) << "the plate at 1.45 m";
  EXPECT_EQ(report.pixels.front + report.pixels.beyond, 0U);
}

TEST(Pipeline, RefusesAFaultyConfiguration) {
  const std::pair<const char*, std::function<void(Camera&, PipelineConfig&)>> faults[] = {
      {"slap", [](Camera&, PipelineConfig& c) { c.camera_parent = "slap"; }},
      {"rigid", [](Camera&, PipelineConfig& c) { c.T_parent_camera.linear() *= 1.001; }},
      {"rigid", [](Camera&, PipelineConfig& c) { c.T_parent_camera.linear()(0, 0) = -1.0; }},
      {"rigid",
       [](Camera&, PipelineConfig& c) { c.T_parent_camera.translation().x() = std::nan(""); }},
      {"camera pose",
       [](Camera&, PipelineConfig& c) { c.T_parent_camera.translation().x() = 1e300; }},
      {"0.5",
       [](Camera& camera, PipelineConfig&) {
         camera.range = {3.0, 0.5};
       }},
      {"0", [](Camera&, PipelineConfig& c) { c.renderer.threads = 0; }}};
  for (const auto& [part, spoil] : faults) {
    Camera camera = slab_camera();
    PipelineConfig config = plain_config();
    spoil(camera, config);
    expect_refused([&] { const Pipeline pipeline(slab_robot(), camera, config); }, {part});
  }
}

}  // namespace
}  // namespace penumbra::test
