// SPDX-License-Identifier: Apache-2.0
// Targets where robot cannot be drawn, as a lens model does not reach there.
#include "target_frame.hpp"

#include <array>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>

namespace penumbra {
namespace {

using test::box_target;
using test::TargetFrame;

constexpr int uncovered_from = 120;  // columns from there on

Camera lens_camera() {
  Camera camera = TargetFrame::camera();
  camera.distortion = Distortion("plumb_bob", std::array{1e-3, 0.0, 0.0, 0.0});
  return camera;
}

class UncoveredTargets : public testing::Test {
 protected:
  /// The frame's images, unknown from the column on.
  LabelledImages images() {
    LabelledImages images = frame_.images();
    for (int v = 0; v < TargetFrame::height; ++v)
      for (int u = 0; u < TargetFrame::width; ++u)
        labels_(u, v) = u < uncovered_from ? images.labels.labels(u, v)
                                           : static_cast<std::uint8_t>(Label::unknown);
    images.labels.labels = labels_.view();
    images.labels.touched = nullptr;
    return images;
  }
  Judgement judge(const TargetView& target) {
    judge_.begin(images());
    return judge_.judge(target);
  }
  void expect_reason(const Judgement& judgement, std::string_view part) {
    EXPECT_EQ(judgement.verdict, Verdict::unknown);
    EXPECT_NE(judgement.reason.find(part), std::string_view::npos) << judgement.reason;
  }

  TargetFrame frame_;
  Image<std::uint8_t> labels_{TargetFrame::width, TargetFrame::height};
  TargetJudge judge_{lens_camera(), frame_.rule, 3};
};

TEST_F(UncoveredTargets, FirstSeenBesideAreUnknown) {
  expect_reason(judge(box_target("beside", {100, 40, 15, 20}, Extent::modal)), "first seen");
  EXPECT_EQ(judge(box_target("away", {20, 40, 15, 20}, Extent::modal)).verdict, Verdict::visible);
  EXPECT_EQ(judge(box_target("all of it", {100, 40, 15, 20})).verdict, Verdict::visible);
}

TEST_F(UncoveredTargets, HaveNoPointsBeside) {
  EXPECT_FALSE(judge(box_target("beside", {113, 40, 6, 20})).point);
  EXPECT_TRUE(judge(box_target("away", {20, 40, 10, 20})).point);
}

TEST_F(UncoveredTargets, SayWhyTheyAreUnknown) {
  expect_reason(judge(box_target("in it", {110, 40, 20, 20})), "lens model");
  // Robot about where the target is expected is no matter of the lens.
  frame_.add_robot(30, 40, 50, 60, 1.0f, 1);
  TargetView target = box_target("at the robot", {30, 40, 91, 20});
  target.expected_depth = 1.0;
  target.thresholds.past_limit = 1;
  expect_reason(judge(target), "the robot's own depth");
  // Robot behind the target hides nothing: what is unknown of it is uncovered.
  target = box_target("before the robot", {30, 40, 110, 20});
  target.expected_depth = 0.5;
  target.thresholds.past_limit = 1;
  expect_reason(judge(target), "lens model");
}

}  // namespace
}  // namespace penumbra
