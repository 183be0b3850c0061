// SPDX-License-Identifier: Apache-2.0
// Verdicts without a depth camera, in a scene whose depth a formula tells.
#include "slab_scene.hpp"

#include <penumbra/pipeline/without_robot.hpp>
#include <penumbra/session/session.hpp>

namespace penumbra::test {
namespace {

constexpr double clear_of_robot = 0.03;  // metres: over the tolerance of 0.02
const auto robot_depth_at = [](int u, int v, double slide) {
  return cast(slab_camera().intrinsics.ray(u, v), slide);
};

PipelineConfig without_depth() {
  PipelineConfig config = plain_config();
  config.has_depth = false;
  return config;
}

/// A box of pixels at a depth, somewhere in the image.
RegionTarget random_region(std::mt19937_64& random) {
  const auto whole = [&](int low, int high) {
    return double(std::uniform_int_distribution(low, high)(random));
  };
  return {.region = PixelBox{whole(0, 140), whole(0, 100), whole(4, 20), whole(4, 20)},
          .extent = Extent::amodal,
          .expected_depth = std::uniform_real_distribution(0.5, 2.8)(random)};
}

struct RegionTruth {
  int inside = 0, hidden = 0, close = 0;  // pixels; the last: the robot is at the target's depth
};

RegionTruth truth_of(const RegionTarget& target, double slide) {
  const auto& box = std::get<PixelBox>(target.region);
  const Intrinsics& image = slab_camera().intrinsics;
  RegionTruth truth;
  for (double v = box.v; v < std::min(box.v + box.height, double(image.height())); ++v)
    for (double u = box.u; u < std::min(box.u + box.width, double(image.width())); ++u) {
      const Seen seen = robot_depth_at(int(u), int(v), slide);
      ++truth.inside;
      if (seen.link == 0) continue;
      truth.close += std::abs(seen.depth - *target.expected_depth) < clear_of_robot ? 1 : 0;
      truth.hidden += seen.depth < *target.expected_depth ? 1 : 0;
    }
  return truth;
}

TEST(WithoutDepth, VerdictsComeFromTheModel) {
  Session session(slab_robot(), slab_camera(), without_depth());
  std::mt19937_64 random = seeded_random(401);
  std::size_t hidden = 0, partial = 0, visible = 0;
  for (int i = 0; i < 400; ++i) {
    const double slide = std::uniform_real_distribution(-0.3, 0.9)(random);
    const RegionTarget region = random_region(random);
    const RegionTruth truth = truth_of(region, slide);
    if (truth.close > 0) continue;
    const FrameReport& report = session.process(
        {.pose = {.positions = {slide}}, .targets = {{.name = "region", .shape = region}}});
    EXPECT_EQ(report.status, FrameStatus::ok);
    const TargetReport& target = report.targets[0];
    const double share = double(truth.hidden) / truth.inside;
    ASSERT_TRUE(target.judgement);
    EXPECT_NEAR(target.judgement->occluded, share, 1e-9);
    EXPECT_FALSE(target.judgement->hidden_by_other);
    const TargetThresholds thresholds;
    const Verdict expected = share > thresholds.hidden_enter    ? Verdict::hidden
                             : share > thresholds.partial_enter ? Verdict::partial
                                                                : Verdict::visible;
    session.pipeline().forget_targets();  // no hysteresis
    EXPECT_EQ(target.verdict, expected) << share;
    ++(expected == Verdict::hidden ? hidden : expected == Verdict::partial ? partial : visible);
  }
  EXPECT_GT(hidden, 10U);
  EXPECT_GT(partial, 20U);
  EXPECT_GT(visible, 20U);
  const std::vector<std::string> lines = session.warnings();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(holds(lines[0], "no depth camera"));
  EXPECT_FALSE(session.drift().is_known);
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
}

}  // namespace
}  // namespace penumbra::test
