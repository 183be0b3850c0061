// SPDX-License-Identifier: Apache-2.0
// What TargetJudge refuses.
#include "../support/errors.hpp"
#include "target_frame.hpp"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using test::box_target;
using test::middle_box;
using test::TargetFrame;

std::string fault_of(const TargetView& target) {
  TargetFrame frame;
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  return test::refusal([&] { (void)judge.judge(target); });
}

TEST(BadTargets, AreRefused) {
  const double nan = std::nan("");
  const std::pair<const char*, std::function<void(TargetView&)>> bad[] = {
      {"has no area",
       [](TargetView& t) {
         t.region = PixelBox{1, 2, 0, 3};
       }},
      {"needs a name", [](TargetView& t) { t.name = ""; }},
      {"expected depth -1 m", [](TargetView& t) { t.expected_depth = -1; }},
      {"expected depth nan", [=](TargetView& t) { t.expected_depth = nan; }},
      {"nan", [=](TargetView& t) { t.depth_margin = nan; }},
      {"-0.1", [](TargetView& t) { t.depth_margin = -0.1; }},
      {"point pixel",
       [=](TargetView& t) {
         t.point_pixel = {nan, 3};
       }},
      {"motion",
       [=](TargetView& t) {
         t.motion = {nan, 3};
       }},
      {"partial_enter 1.1", [](TargetView& t) { t.thresholds.partial_enter = 1.1; }},
      {"partial_leave 0.06", [](TargetView& t) { t.thresholds.partial_leave = 0.06; }},
      {"partial_enter 0.95", [](TargetView& t) { t.thresholds.partial_enter = 0.95; }},
      {"hidden_leave 0.95", [](TargetView& t) { t.thresholds.hidden_leave = 0.95; }},
      {"hidden_leave 0.01", [](TargetView& t) { t.thresholds.hidden_leave = 0.01; }},
      {"unknown_limit nan", [=](TargetView& t) { t.thresholds.unknown_limit = nan; }},
      {"min_inside -1", [](TargetView& t) { t.thresholds.min_inside = -1; }},
      {"min_measured nan", [=](TargetView& t) { t.thresholds.min_measured = nan; }},
      {"point_min_fraction 2", [](TargetView& t) { t.thresholds.point_min_fraction = 2; }}};
  EXPECT_EQ(fault_of(box_target("cup", middle_box)), "");
  for (const auto& [part, change] : bad) {
    TargetView target = box_target("cup", middle_box);
    change(target);
    EXPECT_TRUE(test::holds(fault_of(target), part));
  }
}

TEST(BadTargets, ANameTwiceInAFrame) {
  TargetFrame frame;
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  EXPECT_THROW((void)judge.judge(box_target("cup", middle_box)), std::logic_error);
  judge.begin(frame.images());
  EXPECT_EQ(judge.judge(box_target("cup", middle_box)).verdict, Verdict::visible);
  EXPECT_THROW((void)judge.judge(box_target("cup", middle_box)), InputError);
  judge.begin(frame.images());
  EXPECT_EQ(judge.judge(box_target("cup", middle_box)).verdict, Verdict::visible);
}

}  // namespace
}  // namespace penumbra
