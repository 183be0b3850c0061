// SPDX-License-Identifier: Apache-2.0
// Targets that are followed: which estimates are taken, and where they are said to be; and those of
// earlier frames.
#include "slab_scene.hpp"

namespace penumbra::test {
namespace {

Target followed(const PixelBox& box) {
  return {.name = "hand", .shape = RegionTarget{box}, .handling = PointTrackerConfig{}};
}

TEST_F(TargetsTest, AHiddenPointIsHeld) {
  const TargetReport seen = judge(0, followed(beside_slab));
  ASSERT_TRUE(seen.handled);
  EXPECT_EQ(seen.estimate, Outcome::accepted);
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
  return {.name = "crate",
          .shape = RegionTarget{box},
          .handling = PoseTrackerConfig{},
          .estimate = TargetEstimate{
              .value = at(x, 0.0, 2.0), .stamp = stamp, .frame = ReferenceFrame::root()}};
}

TEST_F(TargetsTest, EstimatesCountWithTheVerdictOfTheirOwnStamp) {
  // Seen at 0 and 100 ms, hidden at 200; estimates come 100 ms late.
  EXPECT_EQ(judge(0, estimated(0, beside_slab, 0.0)).estimate, Outcome::accepted);
  EXPECT_EQ(judge(100 * ms, {.name = "crate", .shape = RegionTarget{beside_slab}}).verdict,
            Verdict::visible);
  const TargetReport late = judge(200 * ms, estimated(100 * ms, behind_slab, 0.01));
  EXPECT_EQ(late.verdict, Verdict::hidden);
  EXPECT_EQ(late.estimate, Outcome::accepted) << "it was visible when it was found";
  EXPECT_EQ(late.handled->source, Source::predicted);
  const TargetReport back = judge(300 * ms, estimated(200 * ms, beside_slab, 0.02));
  EXPECT_EQ(back.estimate, Outcome::refused_verdict) << "it was hidden then";
  const TargetReport other = judge(400 * ms, estimated(350 * ms, beside_slab, 0.03));
  EXPECT_EQ(other.estimate, Outcome::refused_verdict) << "no frame of that stamp";
}

TEST_F(TargetsTest, NothingIsAcceptedWithoutPoseOrDepth) {
  Target target = estimated(0, beside_slab, 0.0);
  target.handling = PoseTrackerConfig{.worst = Verdict::hidden};
  EXPECT_EQ(judge(0, target).estimate, Outcome::accepted);
  target.estimate->stamp = 100 * ms;
  Frame frame{.stamp = 100 * ms, .depth = depth_.view(), .targets = {target}};
  EXPECT_EQ(pipeline_.process(frame).targets[0].estimate, Outcome::refused_verdict);
  frame.stamp = target.estimate->stamp = 200 * ms;
  frame.pose.positions = positions_;
  frame.depth = DepthView{};
  const TargetReport& report = pipeline_.process(frame).targets[0];
  EXPECT_EQ(report.estimate, Outcome::refused_verdict);
  EXPECT_EQ(report.handled->source, Source::predicted) << "handling goes on";
}

TEST_F(TargetsTest, EstimatesOfTheCameraAreBroughtToTheRoot) {
  Camera camera = slab_camera();
  camera.parent = "slab";  // eye in hand
  camera.T_parent_camera = at(0.25, 0, -1.2);
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const Image<float> wall(depth_.width(), depth_.height(), 3.0F);
  for (int i = 0; i < 3; ++i) {
    Target target = estimated(i * 100 * ms, PixelBox{2, 100, 12, 12}, 0.0);
    target.estimate->frame = {};
    target.estimate->value = at(0.0, 0.0, 2.0 - 0.05 * i);  // still in the root's frame
    Frame frame = frame_of(wall, 0.05 * i, {target});
    frame.stamp = i * 100 * ms;
    const TargetReport& report = pipeline.process(frame).targets[0];
    ASSERT_EQ(report.estimate, Outcome::accepted) << report.reason;
    // The camera is 0.25 m beside and 1.2 m before the slab, which is 1 m + slide from the root.
    const Vector3d expected(0.25, 0.0, 1.0 - 1.2 + 2.0);
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
    target.estimate = TargetEstimate{.value = Vector3d(0, 0, z)};
    EXPECT_EQ(judge(0, target).estimate, Outcome::refused_invalid) << z;
    target.estimate->value = at(0, 0, z);
    EXPECT_EQ(judge(0, target).estimate, Outcome::refused_invalid) << z;
    target.estimate->frame = ReferenceFrame::root();  // the root, where the camera is
    EXPECT_EQ(judge(0, target).estimate, Outcome::refused_invalid) << z;
  }
  target.estimate = TargetEstimate{.value = Vector3d(0, 0, 1)};
  EXPECT_EQ(judge(100 * ms, target).estimate, Outcome::accepted) << "not held against it";
}

class LateTargetsTest : public TargetsTest {
 protected:
  LateTargetsTest() : TargetsTest(0.5) {}

  /// The slab stands at `slide` at that stamp.
  const FrameReport& frame_at(std::int64_t stamp, double slide, std::vector<Target> targets) {
    positions_[0] = slide;
    depth_ = scene_depth(slab_camera(), slide);
    return process(stamp, std::move(targets));
  }
};

Target late(const char* name, std::int64_t stamp, const PixelBox& box) {
  return {.name = name, .shape = RegionTarget{box}, .stamp = stamp};
}

/// A detector 100 ms late, with every kind of target: what is said of each frame is the same, and
/// so are verdicts with their hysteresis and the accepted estimates.
TEST_F(LateTargetsTest, SayWhatTargetsInTimeDo) {
  Pipeline in_time(slab_robot(), slab_camera(), plain_config());
  Image<std::uint8_t> mask(depth_.width(), depth_.height());
  for (int u = 96; u < 112; ++u) mask(u, 50) = mask(u, 51) = 1;
  std::vector<Target> targets{
      region("box", PixelBox{98, 46, 22, 9}),
      region("mask", PixelMask{mask.view()}),
      {.name = "keypoint", .shape = KeypointTarget{.pixel = {104, 56}}},
      {.name = "point", .shape = PointTarget{{0.5, 0.0, 1.6}, 0.03, ReferenceFrame::root()}},
      {.name = "solid",
       .shape = BoxTarget{at(0.5, 0.0, 1.6), {0.1, 0.1, 0.1}, ReferenceFrame::of_link("base")}}};
  targets[2].handling = PointTrackerConfig{};
  targets[4].handling = PoseTrackerConfig{};
  constexpr int frames = 12, delay = 2;
  std::vector<std::vector<TargetReport>> said(frames);
  const auto slide = [](int i) { return -0.4 * std::abs(std::sin(0.5 * i)); };
  for (int i = 0; i < frames; ++i) {
    depth_ = scene_depth(slab_camera(), slide(i));
    Frame frame = frame_of(depth_, slide(i), targets);
    frame.stamp = i * 50 * ms;
    const auto& reports = in_time.process(frame).targets;
    said[std::size_t(i)].assign(reports.begin(), reports.end());
  }
  std::size_t changes = 0;
  for (int i = 0; i < frames + delay; ++i) {
    for (Target& target : targets) target.stamp = (i - delay) * 50 * ms;
    const FrameReport& report =
        frame_at(i * 50 * ms, slide(i), i < delay ? std::vector<Target>() : targets);
    if (i < delay) continue;
    const auto frame = std::size_t(i - delay);
    for (std::size_t j = 0; j < targets.size(); ++j) {
      const TargetReport &late = report.targets[j], &live = said[frame][j];
      SCOPED_TRACE(std::string(live.name) + ", frame " + std::to_string(frame));
      EXPECT_EQ(late.verdict, live.verdict) << late.reason;
      ASSERT_TRUE(late.judgement && live.judgement) << late.reason;
      EXPECT_EQ(late.judgement->inside, live.judgement->inside);
      EXPECT_EQ(late.judgement->occluded, live.judgement->occluded);
      EXPECT_EQ(late.judgement->unknown, live.judgement->unknown);
      EXPECT_EQ(late.judgement->hidden_by_other, live.judgement->hidden_by_other);
      EXPECT_EQ(late.point, live.point);
      EXPECT_EQ(late.estimate, live.estimate);
      if (frame > 0 && live.verdict != said[frame - 1][j].verdict) ++changes;
    }
  }
  EXPECT_GT(changes, 5U) << "the slab comes and goes";
}

TEST_F(LateTargetsTest, FramesBeyondTheSpanAreGone) {
  for (int i = 0; i < 20; ++i) frame_at(i * 100 * ms, 0.0, {});
  const PixelBox beside{101, 47, 5, 8};
  expect_verdicts(
      frame_at(2000 * ms, 0.0, {late("old", 200 * ms, beside), late("young", 1500 * ms, beside)}),
      {Verdict::unknown, Verdict::visible});
}

/// Hysteresis is of the order of stamps: one that goes back neither sees nor changes it.
TEST_F(LateTargetsTest, StampsThatGoBackLeaveHysteresisAlone) {
  // At slide 0 the slab hides 1 of 22 columns, 4.5 %: between the thresholds of leave and enter.
  const auto verdict = [&](std::int64_t stamp, double slide, std::int64_t asked) {
    return frame_at(stamp * ms, slide, {late("edge", asked * ms, {98, 46, 22, 9})})
        .targets[0]
        .verdict;
  };
  verdict(0, 0.0, 0);
  ASSERT_EQ(verdict(100, -0.3, 100), Verdict::partial);
  EXPECT_EQ(verdict(200, 0.0, 0), Verdict::visible) << "judged as if for the first time";
  EXPECT_EQ(verdict(200, 0.0, 200), Verdict::partial) << "it has not left that yet";
}

}  // namespace
}  // namespace penumbra::test
