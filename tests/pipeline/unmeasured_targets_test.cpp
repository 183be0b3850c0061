// SPDX-License-Identifier: Apache-2.0
// Targets where the sensor measures nothing, or where a link is not drawn.
#include "targets_fixture.hpp"

#include <utility>

#include <gtest/gtest.h>

#include <penumbra/pipeline/pipeline.hpp>

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

/// The wall behind it is out of range.
TEST_F(TargetsWithinARange, ThinAirIsNotVisibleAndItsPoseNotTaken) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 1.3 * slab_camera().intrinsics.ray(20, 85);
  const Target air{.name = "air",
                   .shape = BoxTarget{pose, {0.1, 0.1, 0.1}, {}},
                   .depth_margin = 0.02,
                   .handling = PoseTrackerConfig{}};
  const TargetReport& report = judge(1 * ms, air);
  EXPECT_EQ(report.verdict, Verdict::unknown);
  EXPECT_EQ(report.judgement->measured, 0.0);
  EXPECT_NE(report.reason.find("hardly anything is measured"), std::string_view::npos)
      << report.reason;
  EXPECT_EQ(report.estimate, penumbra::Outcome::refused_verdict);
  EXPECT_EQ(report.handled->source, Source::lost);
}

/// Three of ten pixels of a dark object are holes.
TEST_F(TargetsWithinARange, AnObjectWithHolesIsVisibleAndItsPoseTaken) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 1.3 * slab_camera().intrinsics.ray(20, 85);
  for (int v = 65; v < 105; ++v)
    for (int u = 0; u < 40; ++u) depth_(u, v) = (u + 3 * v) % 10 < 3 ? 0.0F : 1.25F;
  const Target box{.name = "box",
                   .shape = BoxTarget{pose, {0.1, 0.1, 0.1}, {}},
                   .depth_margin = 0.1,  // its near face is measured
                   .handling = PoseTrackerConfig{}};
  const TargetReport& report = judge(1 * ms, box);
  EXPECT_EQ(report.verdict, Verdict::visible) << report.reason;
  EXPECT_NEAR(*report.judgement->measured, 0.7, 0.05);
  EXPECT_EQ(report.estimate, penumbra::Outcome::accepted);
  EXPECT_EQ(report.handled->source, Source::measured);
  EXPECT_TRUE(report.point);
}

/// It is not hidden by the robot; what a detector says of it was not seen by the sensor.
TEST_F(TargetsWithinARange, NoEstimateIsTakenWhereNothingIsMeasured) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 2.9 * slab_camera().intrinsics.ray(20, 85);
  Target target{.name = "far",
                .shape = RegionTarget{beside_slab},
                .handling = PoseTrackerConfig{},
                .estimate = TargetEstimate{.value = pose, .frame = ReferenceFrame::root()}};
  const TargetReport far = judge(1 * ms, target);
  EXPECT_EQ(far.verdict, Verdict::visible);
  EXPECT_FALSE(far.point);
  EXPECT_EQ(far.estimate, penumbra::Outcome::refused_verdict);
  EXPECT_EQ(far.handled->source, Source::lost);
  target.thresholds.min_measured = 0.0;
  EXPECT_EQ(judge(2 * ms, target).estimate, penumbra::Outcome::accepted) << "asked for";
}

class TargetsWithoutALink : public testing::Test {
 protected:
  Robot robot = Robot::parse(
      slab_urdf(R"(<link name="gone"><collision><geometry><mesh filename="gone.stl"/></geometry>
                   </collision></link>
                   <joint name="weld" type="fixed"><parent link="base"/><child link="gone"/>
                   </joint>)"),
      ".", {.allow_missing_meshes = true});
  Pipeline pipeline{std::move(robot), slab_camera(), plain_config()};
  const Image<float> depth = scene_depth(slab_camera(), 0.0);
  const std::vector<double> positions{0.0};
};

TEST_F(TargetsWithoutALink, AreNeverVisible) {
  const PixelBox half_behind{40, 50, 20, 12}, outside{-50, 50, 20, 12};
  const std::vector<Target> targets{region("clear", beside_slab), region("hidden", behind_slab),
                                    region("half", half_behind), region("outside", outside)};
  const FrameReport& report = pipeline.process(
      {.stamp = 1, .depth = depth.view(), .pose = {.positions = positions}, .targets = targets});
  ASSERT_EQ(report.status, FrameStatus::missing_link);
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_NE(report.targets[0].reason.find("'gone'"), std::string_view::npos);
  EXPECT_FALSE(report.targets[0].point) << "the link's own body may be there";
  EXPECT_EQ(report.targets[0].judgement->clear, 0.0);
  EXPECT_EQ(report.targets[0].judgement->unknown, 1.0);
  EXPECT_EQ(report.targets[1].verdict, Verdict::hidden);
  EXPECT_EQ(report.targets[2].verdict, Verdict::unknown) << "not partial: its rest is not clear";
  EXPECT_NE(report.targets[2].reason.find("'gone'"), std::string_view::npos);
  const Judgement& half = *report.targets[2].judgement;
  EXPECT_NEAR(half.occluded, 12.0 / 20.0, 1e-9);
  EXPECT_NEAR(half.unknown, 8.0 / 20.0, 1e-9);
  EXPECT_EQ(half.clear + half.front, 0.0);
  EXPECT_EQ(report.targets[3].verdict, Verdict::out_of_view);
}

}  // namespace
}  // namespace penumbra::test
