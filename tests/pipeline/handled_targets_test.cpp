// SPDX-License-Identifier: Apache-2.0
// Targets that are followed: which estimates are taken, and where they are said to be.
#include "../support/errors.hpp"
#include "targets_fixture.hpp"

#include <cmath>
#include <limits>
#include <variant>

#include <gtest/gtest.h>

#include <penumbra/pipeline/pipeline.hpp>

namespace penumbra::test {
namespace {

Target followed(const PixelBox& box) {
  return {.name = "hand", .shape = RegionTarget{box}, .handling = PointTrackerConfig{}};
}

TEST_F(TargetsTest, AHiddenPointIsHeld) {
  const TargetReport seen = judge(0, followed(beside_slab));
  ASSERT_TRUE(seen.handled);
  EXPECT_EQ(seen.estimate, penumbra::Outcome::accepted);
  EXPECT_EQ(seen.handled->source, Source::measured);
  EXPECT_EQ(seen.handled->position, seen.point);
  const TargetReport hidden = judge(100 * ms, followed(behind_slab));
  EXPECT_FALSE(hidden.estimate) << "there is no point to take";
  EXPECT_EQ(hidden.handled->source, Source::held);
  EXPECT_NEAR(hidden.handled->age, 0.1, 1e-9);
  EXPECT_EQ(hidden.handled->position, seen.point);
  EXPECT_GT(hidden.handled->sigma, seen.handled->sigma);
  const TargetReport gone = judge(9000 * ms, {.name = "hand", .handling = PointTrackerConfig{}});
  EXPECT_EQ(gone.handled->source, Source::lost);
  EXPECT_FALSE(gone.handled->position);
}

Target estimated(std::int64_t stamp, const PixelBox& box, double x) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, 0.0, 2.0);
  return {
      .name = "crate",
      .shape = RegionTarget{box},
      .handling = PoseTrackerConfig{},
      .estimate = TargetEstimate{.value = pose, .stamp = stamp, .frame = ReferenceFrame::root()}};
}

TEST_F(TargetsTest, EstimatesCountWithTheVerdictOfTheirOwnStamp) {
  // Seen at 0 and 100 ms, hidden at 200; estimates come 100 ms late.
  EXPECT_EQ(judge(0, estimated(0, beside_slab, 0.0)).estimate, penumbra::Outcome::accepted);
  EXPECT_EQ(judge(100 * ms, {.name = "crate", .shape = RegionTarget{beside_slab}}).verdict,
            Verdict::visible);
  const TargetReport late = judge(200 * ms, estimated(100 * ms, behind_slab, 0.01));
  EXPECT_EQ(late.verdict, Verdict::hidden);
  EXPECT_EQ(late.estimate, penumbra::Outcome::accepted) << "it was visible when it was found";
  EXPECT_EQ(late.handled->source, Source::predicted);
  const TargetReport back = judge(300 * ms, estimated(200 * ms, beside_slab, 0.02));
  EXPECT_EQ(back.estimate, penumbra::Outcome::refused_verdict) << "it was hidden then";
  const TargetReport other = judge(400 * ms, estimated(350 * ms, beside_slab, 0.03));
  EXPECT_EQ(other.estimate, penumbra::Outcome::refused_verdict) << "no frame of that stamp";
}

TEST_F(TargetsTest, NothingIsAcceptedWithoutPoseOrDepth) {
  PoseTrackerConfig any;
  any.worst = Verdict::hidden;
  Target target = estimated(0, beside_slab, 0.0);
  target.handling = any;
  EXPECT_EQ(judge(0, target).estimate, penumbra::Outcome::accepted);
  target.estimate->stamp = 100 * ms;
  Frame frame{.stamp = 100 * ms, .depth = depth_.view(), .targets = {target}};
  EXPECT_EQ(pipeline_.process(frame).targets[0].estimate, penumbra::Outcome::refused_verdict);
  frame.stamp = target.estimate->stamp = 200 * ms;
  frame.pose.positions = positions_;
  frame.depth = DepthView{};
  const TargetReport& report = pipeline_.process(frame).targets[0];
  EXPECT_EQ(report.estimate, penumbra::Outcome::refused_verdict);
  EXPECT_EQ(report.handled->source, Source::predicted) << "handling goes on";
}

TEST_F(TargetsTest, EstimatesOfTheCameraAreBroughtToTheRoot) {
  PipelineConfig config = plain_config();
  config.T_parent_camera.translation().x() = 0.25;
  config.camera_parent = "slab";  // eye in hand
  config.T_parent_camera.translation().z() = -1.2;
  Pipeline pipeline(slab_robot(), slab_camera(), config);
  const Image<float> wall(depth_.width(), depth_.height(), 3.0F);
  for (int i = 0; i < 3; ++i) {
    positions_[0] = 0.05 * i;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.0, 0.0, 2.0 - 0.05 * i);  // still in the root's frame
    Target target = estimated(i * 100 * ms, PixelBox{2, 100, 12, 12}, 0.0);
    target.estimate->frame = {};
    target.estimate->value = pose;
    const TargetReport& report = pipeline
                                     .process({.stamp = i * 100 * ms,
                                               .depth = wall.view(),
                                               .pose = {.positions = positions_},
                                               .targets = {target}})
                                     .targets[0];
    ASSERT_EQ(report.estimate, penumbra::Outcome::accepted) << report.reason;
    // The camera is 0.25 m beside and 1.2 m before the slab, which is 1 m + slide from the root.
    const Eigen::Vector3d expected(0.25, 0.0, 1.0 - 1.2 + 2.0);
    EXPECT_LT((*report.handled->position - expected).norm(), 1e-6);
  }
}

TEST_F(TargetsTest, AForgottenTargetStartsAnew) {
  judge(0, followed(beside_slab));
  pipeline_.forget_target("hand");
  EXPECT_EQ(judge(100 * ms, followed(behind_slab)).handled->source, Source::lost);
  judge(200 * ms, followed(beside_slab));
  EXPECT_EQ(judge(-7000 * ms, followed(behind_slab)).handled->source, Source::lost)
      << "a clock that is set back begins a new sequence";
}

TEST_F(TargetsTest, NothingStandsForAnEstimateThatWasNotFound) {
  Target target = followed(beside_slab);
  target.estimate = TargetEstimate{.value = std::monostate{}};
  const TargetReport none = judge(0, target);
  EXPECT_EQ(none.verdict, Verdict::visible);
  EXPECT_TRUE(none.point) << "which would be taken if estimates were not given from outside";
  EXPECT_FALSE(none.estimate);
  EXPECT_EQ(none.handled->source, Source::lost);
  target.estimate.reset();
  EXPECT_EQ(judge(100 * ms, target).handled->source, Source::measured);
}

/// Made of a hole in the depth image: depth 0 is no measurement.
TEST_F(TargetsTest, EstimatesInTheCameraAreInvalid) {
  Target target = followed(beside_slab);
  for (const double z : {0.0, 0.009}) {
    target.estimate = TargetEstimate{.value = Eigen::Vector3d(0, 0, z)};
    EXPECT_EQ(judge(0, target).estimate, penumbra::Outcome::refused_invalid) << z;
    target.estimate->value = Eigen::Isometry3d(Eigen::Translation3d(0, 0, z));
    EXPECT_EQ(judge(0, target).estimate, penumbra::Outcome::refused_invalid) << z;
    target.estimate->frame = ReferenceFrame::root();  // the root, where the camera is
    EXPECT_EQ(judge(0, target).estimate, penumbra::Outcome::refused_invalid) << z;
  }
  target.estimate = TargetEstimate{.value = Eigen::Vector3d(0, 0, 1)};
  EXPECT_EQ(judge(100 * ms, target).estimate, penumbra::Outcome::accepted) << "not held against it";
}

}  // namespace
}  // namespace penumbra::test
