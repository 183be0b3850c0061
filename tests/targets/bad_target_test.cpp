// SPDX-License-Identifier: Apache-2.0
// What TargetJudge refuses, and in which words.
#include "target_frame.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

namespace penumbra {
namespace {

using test::box_target;
using test::middle_box;
using test::TargetFrame;

std::string fault_of(const TargetView& target) {
  TargetFrame frame;
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  try {
    (void)judge.judge(target);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

const double nan = std::numeric_limits<double>::quiet_NaN();

TEST(BadTargets, AreRefusedByName) {
  EXPECT_EQ(fault_of(box_target("cup", {1, 2, 0, 3})),
            "box 1, 2, 0 x 3: has no area: width and height must be above 0");
  EXPECT_EQ(fault_of(box_target("", middle_box)), "needs a name");
}

TEST(BadTargets, NumbersOutOfBounds) {
  const auto fault = [](const auto& change) {
    TargetView target = box_target("cup", middle_box);
    change(target);
    return fault_of(target);
  };
  EXPECT_EQ(fault([](TargetView&) {}), "no fault");
  EXPECT_EQ(fault([](TargetView& t) { t.expected_depth = -1; }),
            "expected depth -1 m: must be above 0 and up to 1e+06");
  EXPECT_NE(fault([](TargetView& t) { t.expected_depth = nan; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.depth_margin = nan; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.depth_margin = -0.1; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.point_pixel = {nan, 3}; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.motion = {nan, 3}; }), "no fault");
  EXPECT_EQ(fault([](TargetView& t) { t.thresholds.partial_enter = 1.1; }),
            "partial_enter 1.1: must be 0 to 1");
  EXPECT_EQ(fault([](TargetView& t) { t.thresholds.partial_leave = 0.06; }),
            "partial_leave 0.06: must not exceed partial_enter 0.05");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.partial_enter = 0.95; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.hidden_leave = 0.95; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.hidden_leave = 0.01; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.unknown_limit = nan; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.min_inside = -1; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.min_measured = nan; }), "no fault");
  EXPECT_NE(fault([](TargetView& t) { t.thresholds.point_min_fraction = 2; }), "no fault");
}

TEST(BadTargets, RenderedOnesHaveTheirOwnDepthAndExtent) {
  const Image<float> depth(TargetFrame::width, TargetFrame::height, 1.0f);
  TargetView target = box_target("cup", middle_box);
  target.region = RenderedRegion{depth.view(), nullptr};
  target.expected_depth = 1.0;
  EXPECT_NE(fault_of(target), "no fault");
  target.expected_depth = {};
  EXPECT_EQ(fault_of(target), "no fault");
  target.extent = Extent::modal;
  EXPECT_NE(fault_of(target), "no fault");
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

TEST(BadTargets, ImagesOfAnotherSize) {
  TargetFrame frame;
  const Image<float> small(10, 10);
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  LabelledImages images = frame.images();
  images.measured = small.view();
  EXPECT_THROW(judge.begin(images), InputError);
  images = frame.images();
  images.virtual_depth.depth = small.view();
  EXPECT_THROW(judge.begin(images), InputError);
  EXPECT_THROW(judge.begin({}), InputError);
}

}  // namespace
}  // namespace penumbra
