// SPDX-License-Identifier: Apache-2.0
// The default rule on the real recording, without anything in front of the robot, and on objects
// pasted into it. docs/tuning.md has the full study.
#include "../support/data.hpp"
#include "../support/pasted_object.hpp"
#include "../support/real_frames.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

class RealRecording : public testing::Test {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    frames = test::load_real_frames(test::data_folder() / "xarm7_realsense");
    ASSERT_EQ(frames.size(), 10u);
  }

  /// Percent of the objects' measured pixels, but for the band at the edge, that are front.
  double front_percent(double gap) {
    Classifier classifier(frames[0].robot.width(), frames[0].robot.height(), LabelRule{});
    test::Paster paster({}, 51);
    std::size_t front = 0, all = 0;
    for (test::RealFrame& frame : frames) {
      for (int i = 0; i < 20; ++i) {
        paster.paste(frame, {test::Shape::square, 0.05, 0.0}, gap);
        const auto labels = classifier.classify(frame.view(), frame.measured.view()).labels;
        for (const int pixel : paster.core())
          front += labels(pixel % labels.width, pixel / labels.width) ==
                   static_cast<std::uint8_t>(Label::front);
        all += paster.core().size();
        paster.undo(frame);
      }
    }
    return 100.0 * static_cast<double>(front) / static_cast<double>(all);
  }

  std::vector<test::RealFrame> frames;
};

TEST_F(RealRecording, HasHardlyAnyFalseFront) {
  Classifier classifier(frames[0].robot.width(), frames[0].robot.height(), LabelRule{});
  Classifier paper(frames[0].robot.width(), frames[0].robot.height(), LabelRule::paper());
  std::size_t paper_front = 0, mask = 0;
  for (const test::RealFrame& frame : frames) {
    const auto front = classifier.classify(frame.view(), frame.measured.view()).pixels[1];
    EXPECT_LT(static_cast<double>(front), 0.005 * static_cast<double>(frame.mask_pixels));
    paper_front += paper.classify(frame.view(), frame.measured.view()).pixels[1];
    mask += frame.mask_pixels;
  }
  // The constant of the paper calls six percent front: the recording can tell rules apart.
  EXPECT_GT(static_cast<double>(paper_front), 0.05 * static_cast<double>(mask));
}

TEST_F(RealRecording, ShowsObjectsFiveCentimetresBeforeTheRobot) {
  EXPECT_GE(front_percent(0.05), 99.0);
}

TEST_F(RealRecording, ShowsMostOfObjectsThreeCentimetresBeforeTheRobot) {
  EXPECT_GE(front_percent(0.03), 95.0);  // 98.7 measured
}

}  // namespace
}  // namespace penumbra
