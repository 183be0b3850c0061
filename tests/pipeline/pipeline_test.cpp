// SPDX-License-Identifier: Apache-2.0
#include "../support/opengl.hpp"
#include "slab_scene.hpp"

#include <penumbra/diagnosis/diagnosis.hpp>

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
  for (const auto [u, v] : each_pixel(k)) {
    const bool robot = cast(k.ray(u, v), slide).depth > 0.0;
    const int kind = u / 3 % 8;
    scene.depth(u, v) = kind < 7 ? scene.depth(u, v) + changes[kind] : 0.0F;
    const Label label = kind < 7 ? labels[kind] : Label::unknown;
    scene.labels(u, v) = std::uint8_t(robot ? label : Label::clear);
  }
  return scene;
}

PENUMBRA_BACKEND_TEST(PipelineOf);

TEST_P(PipelineOf, LabelsEveryPixelAsTheRuleSays) {
  const Camera camera = slab_camera();
  const EditedScene scene = edited_scene(camera, 0.1);
  const Image<std::uint16_t> millimetres = to_millimetres(scene.depth);
  Pipeline pipeline(slab_robot(), camera, plain_config(GetParam()));
  for (const DepthView& depth :
       {DepthView(scene.depth.view()), DepthView(std::as_const(millimetres).view())}) {
    const FrameReport& report =
        pipeline.process({.stamp = 7, .depth = depth, .pose = {.positions = {0.1}}});
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

TEST(Pipeline, RefusesAFaultyConfiguration) {
  using Config = PipelineConfig;
  const std::pair<const char*, std::function<void(Config&)>> faults[] = {
      {"slap", [](Config& c) { c.camera_parent = "slap"; }},
      {"rigid", [](Config& c) { c.T_parent_camera.linear() *= 1.001; }},
      {"rigid", [](Config& c) { c.T_parent_camera.linear()(0, 0) = -1.0; }},
      {"rigid", [](Config& c) { c.T_parent_camera.translation().x() = nan; }},
      {"camera pose", [](Config& c) { c.T_parent_camera.translation().x() = 1e300; }},
      {"0", [](Config& c) { c.renderer.threads = 0; }}};
  for (const auto& [part, spoil] : faults) {
    Config config = plain_config();
    spoil(config);
    expect_refused([&, &c = config] { Pipeline(slab_robot(), slab_camera(), c); }, {part});
  }
  Camera camera = slab_camera();
  camera.range = {3.0, 0.5};
  expect_refused([&] { Pipeline(slab_robot(), camera, plain_config()); }, {"0.5"});
}

/// The fringe of a thing at the slab's left border, at its depth, after a frame in which the slab
/// was far from it.
std::size_t fringe_of_thing(double scene_memory, std::int64_t seconds_later = 1) {
  const Camera camera{Intrinsics(1288, 968, 962.4, 949.6, 585.7, 459.4), {}, {}, {}};
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = 8;
  config.rule.scene_memory = scene_memory;
  Pipeline pipeline(slab_robot(), camera, config);
  const SlabBox thing{{-0.3005, 0.0, 1.0}, {0.2, 0.2, 0.1}, 0};
  const Image<float> before = scene_depth(camera, 1.0, {thing});
  const Image<float> now = scene_depth(camera, 0.0, {thing});
  Frame frame = frame_of(before, 1.0);
  frame.stamp = 1'000'000'000;
  EXPECT_EQ(pipeline.process(frame).pixels.fringe, 0U);
  frame = frame_of(now, 0.0);
  frame.stamp = (1 + seconds_later) * 1'000'000'000;
  return pipeline.process(frame).pixels.fringe;
}

TEST(SceneMemory, KeepsAThingThatWasSeenBefore) {
  const std::size_t alone = fringe_of_thing(0.0);
  EXPECT_EQ(fringe_of_thing(60.0), 0U);
  EXPECT_EQ(fringe_of_thing(60.0, 61), alone);
  EXPECT_GT(alone, 0U);
}

/// What is said of a box of the slab's depth that touches the slab at slide = 0, and then is
/// carried along by a share of the slab's motion.
std::vector<std::string> said_of_a_box(double share) {
  const Camera camera = slab_camera();
  PipelineConfig config = plain_config();
  config.rule.fringe_reach = 40;
  Pipeline pipeline(slab_robot(), camera, config);
  SetupCheck check(pipeline.robot(), camera, 0);
  for (const double slide : {0.0, 0.1, 0.3, 0.2}) {
    const SlabBox box{{-0.35, 0.0, 1.0 + share * slide}, {0.3, 0.2, 0.1}, 0};
    const Image<float> depth = scene_depth(camera, slide, {box});
    check.add(pipeline.process(frame_of(depth, slide)), {});
  }
  return check.missing_parts(config.rule.fringe_reach);
}

/// Which links carry a part that the URDF lacks.
TEST(MissingParts, NameTheLinkThatCarriesOneAndNotWhatStandsStill) {
  const std::vector<std::string> lines = said_of_a_box(1.0);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(holds(lines[0], "'slab'"));
  EXPECT_TRUE(said_of_a_box(0.0).empty());
}

}  // namespace
}  // namespace penumbra::test
