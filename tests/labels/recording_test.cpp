// SPDX-License-Identifier: Apache-2.0
// The default rule on the real recording: without anything in front of the robot, and on objects
// pasted before and beside it. docs/tuning.md and bench/results/points.txt have the full studies.
#include "../support/cloud_measure.hpp"
#include "../support/data.hpp"
#include "../support/pasted_objects.hpp"
#include "../support/test.hpp"

namespace penumbra::test {
namespace {

class RealRecording : public testing::Test {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_DATA();
    frames = load_real_frames(data_folder() / "xarm7_realsense");
    ASSERT_EQ(frames.size(), 10u);
    for (const RealFrame& frame : frames) nearest.push_back(nearest_robot(frame.robot.view()));
  }

  [[nodiscard]] Classifier classifier(const LabelRule& rule = {}) const {
    return {frames[0].robot.width(), frames[0].robot.height(), rule};
  }

  static LabelRule without_fringe() {
    LabelRule rule;
    rule.fringe_reach = 0;
    return rule;
  }

  /// Percent of the pixels of squares of 5 cm that are front.
  double front_percent(double gap) {
    Classifier used = classifier();
    Paster paster(51);
    std::size_t front = 0, all = 0;
    for (RealFrame& frame : frames)
      for (int i = 0; i < 20; ++i) {
        paster.paste_before(frame, {Outline::plate, 0.05}, gap);
        const LabelView labels = used.classify(frame.view(), frame.measured.view());
        for (const int pixel : paster.on_robot()) front += label_at(labels, pixel) == Label::front;
        all += paster.on_robot().size();
        paster.undo(frame);
      }
    return percent(front, all);
  }

  std::vector<RealFrame> frames;
  std::vector<tuning::NearestPixels> nearest;
};

TEST_F(RealRecording, HasHardlyAnyFalseFront) {
  Classifier used = classifier(), paper = classifier(LabelRule::paper());
  std::size_t paper_front = 0, mask = 0;
  for (const RealFrame& frame : frames) {
    const auto front = used.classify(frame.view(), frame.measured.view()).pixels[1];
    EXPECT_LT(double(front), 0.005 * double(frame.mask_pixels));
    paper_front += paper.classify(frame.view(), frame.measured.view()).pixels[1];
    mask += frame.mask_pixels;
  }
  // The constant of the paper calls six percent front: the recording can tell rules apart.
  EXPECT_GT(double(paper_front), 0.05 * double(mask));
}

TEST_F(RealRecording, ShowsObjectsBeforeTheRobot) {
  EXPECT_GE(front_percent(0.05), 99.0);
  EXPECT_GE(front_percent(0.03), 95.0);
}

TEST_F(RealRecording, HasHardlyAnyPointOfTheRobotInItsCloud) {
  EXPECT_GT(measure_leftover(frames, nearest, without_fringe()).percent(), 10.0);
  EXPECT_LT(measure_leftover(frames, nearest, LabelRule{}).percent(), 0.2);
}

TEST_F(RealRecording, KeepsObjectsThatTouchTheOutlineAtATrueStep) {
  Classifier used = classifier();
  Paster paster(52);
  Kept kept;
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (const auto outline : {Outline::plate, Outline::hand})
      for (const double offset : {-0.10, 0.10, -0.10, 0.10}) {
        paster.paste_beside(frames[i], nearest[i], {outline, 0.09}, 0.0, offset);
        if (paster.has_true_step(frames[i]))
          kept.add(paster.beside(), used.classify(frames[i].view(), frames[i].measured.view()));
        paster.undo(frames[i]);
      }
  EXPECT_GT(kept.placements, 20u);
  EXPECT_GE(kept.percent(), 98.0);
}

TEST_F(RealRecording, FringeIsTakenFromClearPixelsAlone) {
  Classifier with = classifier(), without = classifier(without_fringe());
  for (const RealFrame& frame : frames) {
    const LabelView a = with.classify(frame.view(), frame.measured.view());
    const LabelView b = without.classify(frame.view(), frame.measured.view());
    std::size_t different = 0;
    for (int pixel = 0; pixel < int(frame.robot.size()); ++pixel) {
      const Label label = label_at(a, pixel);
      different += (label == Label::fringe ? Label::clear : label) != label_at(b, pixel);
    }
    EXPECT_EQ(different, 0u);
  }
}

}  // namespace
}  // namespace penumbra::test
