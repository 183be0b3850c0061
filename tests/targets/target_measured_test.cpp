// SPDX-License-Identifier: Apache-2.0
// What nobody measured is not seen: holes, dead sensors and thin air out of the sensor's range.
#include "target_frame.hpp"

#include <optional>

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using test::box_target;
using test::hole;
using test::judge_once;
using test::middle_box;
using test::share_rounding;
using test::TargetFrame;

/// Of what is measured, all is past: holes do not speak for the target.
TEST(Measured, WhatIsNotMeasuredDoesNotMakeUpForWhatIsPast) {
  TargetFrame frame;  // the wall is at 2 m
  frame.see(40, 40, 60, 52, hole);
  TargetView target = box_target("cup", middle_box);
  target.expected_depth = 1.5;
  const Judgement judgement = judge_once(frame, target);
  EXPECT_NEAR(*judgement.seen_past, 0.4, share_rounding);
  EXPECT_NEAR(*judgement.measured, 0.4, share_rounding);
  EXPECT_EQ(judgement.verdict, Verdict::unknown);
  EXPECT_EQ(judgement.reason, "the sensor looks past where most of it is expected");
}

/// 20 x 20 pixels, of which so many rows are measured where the target is.
Judgement measured_rows(int rows, std::optional<double> expected, double min_measured = 0.2) {
  TargetFrame frame;
  frame.see(40, 40, 60, 60, hole);
  frame.see(40, 40, 60, 40 + rows, 1.5f);
  TargetView target = box_target("cup", middle_box);
  target.expected_depth = expected;
  target.thresholds.min_measured = min_measured;
  return judge_once(frame, target);
}

TEST(Measured, WhatIsHardlyMeasuredIsNotKnownToBeThere) {
  for (const int rows : {0, 1, 3}) {
    const Judgement judgement = measured_rows(rows, 1.5);
    EXPECT_EQ(judgement.verdict, Verdict::unknown) << rows;
    EXPECT_EQ(judgement.reason, "hardly anything is measured where it is expected");
    EXPECT_NEAR(*judgement.measured, rows / 20.0, share_rounding);
    EXPECT_EQ(judgement.clear, 1.0) << "the robot does not hide it";
    EXPECT_FALSE(judgement.point);
    EXPECT_EQ(measured_rows(rows, 1.5, 0).verdict, Verdict::visible) << "asked for";
  }
  EXPECT_EQ(measured_rows(4, 1.5).verdict, Verdict::visible) << "the least share";
  EXPECT_EQ(measured_rows(14, 1.5).verdict, Verdict::visible) << "30 % holes";
  EXPECT_TRUE(measured_rows(14, 1.5).point);
}

/// The verdict is about the robot's body; that nothing is measured there is said beside it.
TEST(Measured, WithoutExpectedDepthWhatIsNotMeasuredIsNotHidden) {
  const Judgement judgement = measured_rows(0, {});
  EXPECT_EQ(judgement.verdict, Verdict::visible);
  EXPECT_EQ(*judgement.measured, 0.0);
  EXPECT_FALSE(judgement.point);
}

TEST(Measured, HolesLeftOfWhatTheRobotHidesAreNotPartial) {
  TargetFrame frame;
  frame.add_robot(40, 40, 60, 50, 1.0f, 1);
  frame.see(40, 50, 60, 60, hole);
  TargetView target = box_target("cup", middle_box);
  target.expected_depth = 1.5;
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::unknown);
  frame.add_robot(40, 50, 60, 59, 1.0f, 1);
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::hidden);
}

}  // namespace
}  // namespace penumbra
