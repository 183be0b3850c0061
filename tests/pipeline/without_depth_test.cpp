// SPDX-License-Identifier: Apache-2.0
// Verdicts without a depth camera, in a scene whose depth a formula tells.
#include "slab_scene.hpp"

#include <penumbra/pipeline/without_robot.hpp>
#include <penumbra/session/session.hpp>

namespace penumbra::test {
namespace {

const auto robot_depth_at = [](int u, int v, double slide) {
  return cast(slab_camera().intrinsics.ray(u, v), slide);
};

PipelineConfig without_depth() {
  PipelineConfig config = plain_config();
  config.has_depth = false;
  return config;
}

TEST(WithoutDepth, AnotherRobotIsPaintedWhereItStandsBeforeTheScene) {
  Pipeline pipeline(slab_robot(), slab_camera(), without_depth());
  const FrameReport& report = pipeline.process({.pose = {.positions = {0.2}}});
  const Tolerance tolerance{.a = 0.02, .b = 0.0, .c = 0.0};
  const auto& virtual_depth = report.virtual_depth.depth;
  Image<float> scene(virtual_depth.width, virtual_depth.height);
  for (const auto [u, v] : each_pixel(scene)) {
    const auto z = float(robot_depth_at(u, v, 0.2).depth);
    // Behind, a little before, far before, not measured.
    const float kinds[] = {z + 0.5F, z - 0.015F, z - 0.03F, 0.0F};
    scene(u, v) = kinds[(u + v) % 4];
  }
  const Image<std::uint8_t> front = front_of(virtual_depth, scene.view(), tolerance);
  for (const auto [u, v] : each_pixel(scene)) {
    const bool is_robot = robot_depth_at(u, v, 0.2).link != 0;
    ASSERT_EQ(front(u, v), is_robot && (u + v) % 4 != 2 ? 255 : 0) << u << ' ' << v;
  }
  EXPECT_THROW((void)front_of(virtual_depth, Image<float>(2, 2).view()), InputError);
}

TEST(WithoutDepth, ATargetOfUnknownDepthIsUnknownBehindTheRobot) {
  Pipeline pipeline(slab_robot(), slab_camera(), without_depth());
  Frame frame{.pose = {.positions = {0.0}}};
  for (const double u : {70.0, 2.0})
    frame.targets.push_back(
        {.name = std::to_string(u),
         .shape = RegionTarget{.region = PixelBox{u, 54, 8, 8}, .extent = Extent::amodal}});
  const FrameReport& report = pipeline.process(frame);
  expect_verdicts(report, {Verdict::unknown, Verdict::visible});
  EXPECT_NE(report.targets[0].reason, "");
}

TEST(WithoutDepth, EstimatesOfWhatTheRobotDoesNotHideAreAccepted) {
  Session session(slab_robot(), slab_camera(), without_depth());
  for (const double u : {5.0, 73.0}) {  // beside the slab, and behind it
    const Vector3d at = 2.0 * slab_camera().intrinsics.ray(u, 57.0);
    Frame frame{.stamp = 1'000'000'000, .pose = {.positions = {0.0}}};
    frame.targets = {{.name = std::to_string(u),
                      .shape = PointTarget{at, 0.03, ReferenceFrame::root()},
                      .handling = PointTrackerConfig{}}};
    const TargetReport& target = session.process(frame).targets[0];
    const bool is_hidden = u == 73.0;
    EXPECT_EQ(target.verdict, is_hidden ? Verdict::hidden : Verdict::visible);
    EXPECT_EQ(target.estimate, is_hidden ? Outcome::refused_verdict : Outcome::accepted);
    EXPECT_EQ(target.handled->source, is_hidden ? Source::lost : Source::measured);
  }
  const std::vector<std::string> lines = session.warnings();
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(holds(lines[0], "no depth camera")) << lines[0];
  EXPECT_FALSE(session.drift().is_known);
}

}  // namespace
}  // namespace penumbra::test
