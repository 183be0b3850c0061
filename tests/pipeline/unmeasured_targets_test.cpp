// SPDX-License-Identifier: Apache-2.0
// Targets where the sensor measures nothing, or in or near links that are not drawn.
#include "slab_scene.hpp"

namespace penumbra::test {
namespace {

class TargetsWithinARange : public TargetsTest {
 protected:
  TargetsWithinARange() {
    Camera camera = slab_camera();
    camera.range = {0.3, 1.6};
    pipeline_ = Pipeline(slab_robot(), camera, plain_config());
  }
};

Target box_at(double depth, double depth_margin) {
  return {.name = "box",
          .shape = BoxTarget{at(depth * slab_camera().intrinsics.ray(20, 85)), {0.1, 0.1, 0.1}, {}},
          .depth_margin = depth_margin,
          .handling = PoseTrackerConfig{}};
}

/// The wall behind it is out of range.
TEST_F(TargetsWithinARange, ThinAirIsNotVisibleAndItsPoseNotTaken) {
  const TargetReport& report = judge(1 * ms, box_at(1.3, 0.02));
  EXPECT_EQ(report.verdict, Verdict::unknown);
  EXPECT_EQ(report.judgement->measured, 0.0);
  EXPECT_TRUE(holds(report.reason, "measured"));
  EXPECT_EQ(report.estimate, Outcome::refused_verdict);
  EXPECT_EQ(report.handled->source, Source::lost);
}

/// Three of ten pixels of a dark object are holes.
TEST_F(TargetsWithinARange, AnObjectWithHolesIsVisibleAndItsPoseTaken) {
  for (const auto [u, v] : each_pixel(0, 65, 40, 105))
    depth_(u, v) = (u + 3 * v) % 10 < 3 ? 0.0F : 1.25F;
  const TargetReport& report = judge(1 * ms, box_at(1.3, 0.1));  // its near face is measured
  EXPECT_EQ(report.verdict, Verdict::visible) << report.reason;
  EXPECT_NEAR(*report.judgement->measured, 0.7, 0.05);
  EXPECT_EQ(report.estimate, Outcome::accepted);
  EXPECT_EQ(report.handled->source, Source::measured);
  EXPECT_TRUE(report.point);
}

/// It is not hidden by the robot; what a detector says of it was not seen by the sensor.
TEST_F(TargetsWithinARange, NoEstimateIsTakenWhereNothingIsMeasured) {
  Target target = region("far", beside_slab);
  target.handling = PoseTrackerConfig{};
  target.estimate = TargetEstimate{.value = at(2.9 * slab_camera().intrinsics.ray(20, 85)),
                                   .frame = ReferenceFrame::root()};
  const TargetReport far = judge(1 * ms, target);
  EXPECT_EQ(far.verdict, Verdict::visible);
  EXPECT_FALSE(far.point);
  EXPECT_EQ(far.estimate, Outcome::refused_verdict);
  EXPECT_EQ(far.handled->source, Source::lost);
  target.thresholds.min_measured = 0.0;
  EXPECT_EQ(judge(2 * ms, target).estimate, Outcome::accepted) << "asked for";
}

TEST(TargetsWithoutALink, AreNeverVisible) {
  Pipeline pipeline(slab_robot_without_mesh(), slab_camera(), plain_config());
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const PixelBox half_behind{40, 50, 20, 12}, outside{-50, 50, 20, 12};
  const FrameReport& report =
      pipeline.process(frame_of(depth, 0.0,
                                {region("clear", beside_slab), region("hidden", behind_slab),
                                 region("half", half_behind), region("outside", outside)}));
  ASSERT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_TRUE(holds(report.message, "'lost'"));
  using enum Verdict;
  expect_verdicts(report, {unknown, hidden, unknown, out_of_view});  // half: its rest is not clear
  for (const std::size_t i : {0U, 2U}) EXPECT_TRUE(holds(report.targets[i].reason, "'lost'"));
  EXPECT_FALSE(report.targets[0].point) << "the link's own body may be there";
  EXPECT_EQ(report.targets[0].judgement->clear, 0.0);
  EXPECT_EQ(report.targets[0].judgement->unknown, 1.0);
  const Judgement& half = *report.targets[2].judgement;
  EXPECT_NEAR(half.occluded, 12.0 / 20.0, 1e-9);
  EXPECT_NEAR(half.unknown, 8.0 / 20.0, 1e-9);
  EXPECT_EQ(half.clear + half.front, 0.0);
}

TEST_F(TargetsTest, OfAnUncertainLinkAreUnknownInThatLinkAlone) {
  Frame frame = frame_of(depth_);
  for (const char* const link : {"plate", "slab", "base"})
    frame.targets.push_back({.name = link,
                             .shape = PointTarget{.position = {0.0, 0.0, 0.3},
                                                  .frame = ReferenceFrame::of_link(link)}});
  frame.pose.uncertain_links = {*slab_robot().find_link("plate")};
  frame.pose.uncertain_reason = "two publishers differ";
  const FrameReport& report = pipeline_.process(frame);
  EXPECT_EQ(report.status, FrameStatus::missing_link);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(report.targets[i].judgement.has_value(), i > 0) << i;
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_TRUE(holds(report.targets[0].reason, {"'plate'", "two publishers differ"}));
  frame.pose.uncertain_links = {0};
  EXPECT_EQ(pipeline_.process(frame).status, FrameStatus::missing_transform)
      << "it carries the camera";
}

}  // namespace
}  // namespace penumbra::test
