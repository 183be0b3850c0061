// SPDX-License-Identifier: Apache-2.0
#include "targets_fixture.hpp"

#include <cmath>
#include <limits>

#include <penumbra/base/error.hpp>

namespace penumbra::test {
namespace {

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

Target late(const char* name, std::int64_t stamp, Extent extent = Extent::amodal) {
  // Beside the slab at slide 0, behind it at slide -0.3.
  return {.name = name, .shape = RegionTarget{{PixelBox{101, 47, 5, 8}}, extent}, .stamp = stamp};
}

/// A detector 100 ms late, with every kind of target: what is said of each frame is the same, and
/// so are verdicts with their hysteresis and the accepted estimates.
TEST_F(LateTargetsTest, SayWhatTargetsInTimeDo) {
  PipelineConfig config = plain_config();
  Pipeline in_time(slab_robot(), slab_camera(), config);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.5, 0.0, 1.6);
  Image<std::uint8_t> mask(depth_.width(), depth_.height());
  for (int u = 96; u < 112; ++u) mask(u, 50) = mask(u, 51) = 1;
  std::vector<Target> targets{
      region("box", PixelBox{98, 46, 22, 9}),
      region("mask", PixelMask{mask.view()}),
      {.name = "keypoint", .shape = KeypointTarget{.pixel = {104, 56}}},
      {.name = "point", .shape = PointTarget{{0.5, 0.0, 1.6}, 0.03, ReferenceFrame::root()}},
      {.name = "solid",
       .shape = BoxTarget{pose, {0.1, 0.1, 0.1}, ReferenceFrame::of_link("base")}}};
  targets[2].handling = PointTrackerConfig{};
  targets[4].handling = PoseTrackerConfig{};
  constexpr int frames = 12, delay = 2;
  std::vector<std::vector<TargetReport>> said(frames);
  const auto slide = [](int i) { return -0.4 * std::abs(std::sin(0.5 * i)); };
  for (int i = 0; i < frames; ++i) {
    positions_[0] = slide(i);
    depth_ = scene_depth(slab_camera(), slide(i));
    const auto& reports = in_time
                              .process({.stamp = i * 50 * ms,
                                        .depth = depth_.view(),
                                        .pose = {.positions = positions_},
                                        .targets = targets})
                              .targets;
    said[static_cast<std::size_t>(i)].assign(reports.begin(), reports.end());
  }
  std::size_t changes = 0;
  for (int i = 0; i < frames + delay; ++i) {
    for (Target& target : targets) target.stamp = (i - delay) * 50 * ms;
    const FrameReport& report =
        frame_at(i * 50 * ms, slide(i), i < delay ? std::vector<Target>() : targets);
    if (i < delay) continue;
    const auto frame = static_cast<std::size_t>(i - delay);
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
  const std::vector<Target> targets{late("old", 200 * ms), late("young", 1500 * ms)};
  const FrameReport& report = frame_at(2000 * ms, 0.0, targets);
  EXPECT_EQ(report.targets[0].verdict, Verdict::unknown);
  EXPECT_EQ(report.targets[1].verdict, Verdict::visible);
}

/// Hysteresis is of the order of stamps: one that goes back neither sees nor changes it.
TEST_F(LateTargetsTest, StampsThatGoBackLeaveHysteresisAlone) {
  // At slide 0 the slab hides 1 of 22 columns, 4.5 %: between the thresholds of leave and enter.
  const auto target = [](std::int64_t stamp) {
    Target made = region("edge", PixelBox{98, 46, 22, 9});
    made.stamp = stamp;
    return made;
  };
  const Target first = target(0), second = target(100 * ms);
  frame_at(0, 0.0, {first});
  const Verdict before = frame_at(100 * ms, -0.3, {second}).targets[0].verdict;
  ASSERT_EQ(before, Verdict::partial);
  const Target back = target(0), next = target(200 * ms);
  EXPECT_EQ(frame_at(200 * ms, 0.0, {back}).targets[0].verdict, Verdict::visible)
      << "judged as if for the first time";
  EXPECT_EQ(frame_at(200 * ms, 0.0, {next}).targets[0].verdict, Verdict::partial)
      << "it has not left that yet";
}

}  // namespace
}  // namespace penumbra::test
