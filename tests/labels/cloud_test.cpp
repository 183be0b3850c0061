// SPDX-License-Identifier: Apache-2.0
// How much of the robot the fringe misses in the real recording, and how much it removes of objects
// pasted next to it. docs/cloud.md has the full study.
#include "../support/cloud_measure.hpp"
#include "../support/data.hpp"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

class RealCloud : public testing::Test {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    frames = test::load_real_frames(test::data_folder() / "xarm7_realsense");
    ASSERT_EQ(frames.size(), 10u);
    for (const test::RealFrame& frame : frames)
      nearest.push_back(test::nearest_robot(frame.robot.view()));
  }

  static LabelRule without_fringe() {
    LabelRule rule;
    rule.fringe_reach = 0;
    return rule;
  }

  /// What is kept of plates and hands 10 cm before and behind the outline where there is a true
  /// step of 5 cm.
  test::Kept kept_at_a_true_step(double gap) {
    Classifier classifier(frames[0].robot.width(), frames[0].robot.height(), LabelRule{});
    test::SidePaster paster(52);
    test::Kept kept;
    for (std::size_t i = 0; i < frames.size(); ++i)
      for (const auto outline : {test::Outline::plate, test::Outline::hand})
        for (const double offset : {-0.10, 0.10, -0.10, 0.10}) {
          paster.paste(frames[i], nearest[i], {outline, 0.09, 0.09}, {gap, 0.0}, offset);
          if (paster.has_true_step(frames[i], 0.05, 12.0))
            kept.add(paster.beside(),
                     classifier.classify(frames[i].view(), frames[i].measured.view()));
          paster.undo(frames[i]);
        }
    EXPECT_GT(kept.placements, 20u);
    return kept;
  }

  std::vector<test::RealFrame> frames;
  std::vector<test::NearestRobot> nearest;
};

TEST_F(RealCloud, HasHardlyAnyPointOfTheRobot) {
  EXPECT_GT(measure_leftover(frames, nearest, without_fringe()).percent(), 10.0);
  EXPECT_LT(measure_leftover(frames, nearest, LabelRule{}).percent(), 0.2);
}

TEST_F(RealCloud, KeepsObjectsThatTouchTheOutlineAtATrueStep) {
  EXPECT_GE(kept_at_a_true_step(0.0).core_percent(), 98.0);
}

TEST_F(RealCloud, FringeIsTakenFromClearPixelsAlone) {
  Classifier with(frames[0].robot.width(), frames[0].robot.height(), LabelRule{});
  Classifier without(frames[0].robot.width(), frames[0].robot.height(), without_fringe());
  for (const test::RealFrame& frame : frames) {
    const LabelView a = with.classify(frame.view(), frame.measured.view());
    const LabelView b = without.classify(frame.view(), frame.measured.view());
    std::size_t different = 0;
    for (int pixel = 0; pixel < static_cast<int>(frame.robot.size()); ++pixel) {
      const Label label = test::label_at(a, pixel);
      different += (label == Label::fringe ? Label::clear : label) != test::label_at(b, pixel);
    }
    EXPECT_EQ(different, 0u);
  }
}

}  // namespace
}  // namespace penumbra
