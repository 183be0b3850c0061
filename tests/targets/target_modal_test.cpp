// SPDX-License-Identifier: Apache-2.0
// What a detector's shrinking mask must not hide: targets that move behind the robot and that the
// robot moves before.
#include "target_frame.hpp"

namespace penumbra::test {
namespace {

class ModalTargets : public testing::Test {
 protected:
  /// The verdict on what a detector sees of a box: the part left of the robot, which covers the
  /// columns from `robot` on.
  Judgement see(int u, int robot, std::optional<double> motion = {}) {
    TargetFrame frame = robot_from(robot);
    const int seen = std::min(u + width, robot) - u;
    TargetView target = box_target({double(u), 40, double(seen), 20}, Extent::modal);
    if (motion) target.motion = Vector2d(*motion, 0);
    return judge_in(frame, target);
  }
  static TargetFrame robot_from(int column) {
    TargetFrame frame;
    frame.add_robot(column, 0, TargetFrame::width, TargetFrame::height, 1.0f, 1);
    return frame;
  }
  Judgement judge_in(TargetFrame& frame, TargetView target) {
    target.expected_depth = depth;
    judge.begin(frame.images());
    return judge.judge(target, memory);
  }

  static constexpr int width = 40;
  static constexpr double behind = TargetFrame::wall;  // metres: the robot is at 1 m
  std::optional<double> depth;
  TargetJudge judge{TargetFrame::camera(), TargetFrame::without_cleanup(), 3};
  TargetMemory memory;
};

TEST_F(ModalTargets, AreJudgedByTheirLastGoodExtentToo) {
  EXPECT_EQ(see(20, 100).verdict, Verdict::visible);
  const Judgement half = see(20, 40);
  EXPECT_EQ(half.verdict, Verdict::partial);
  EXPECT_NEAR(half.occluded, 0.5, share_rounding);
  EXPECT_EQ(half.inside, 800u);
  ASSERT_EQ(half.blame.size(), 1u);
  EXPECT_EQ(half.blame[0].link, 1u);
  const Judgement most = see(20, 22);
  EXPECT_EQ(most.verdict, Verdict::hidden);
  EXPECT_EQ(see(20, 100).verdict, Verdict::visible);
}

/// Something covers six tenths of the target while the robot is far. Then the robot does.
TEST_F(ModalTargets, AreNotSmallerBecauseSomethingCoveredThem) {
  const PixelBox rest{20, 40, 0.4 * width, 20};
  for (const std::optional<double> expected : {std::optional<double>(), std::optional(behind)})
    for (const int frames : {1, 100}) {
      memory = {};
      depth = expected;
      EXPECT_EQ(see(20, 120).verdict, Verdict::visible);
      TargetFrame far = robot_from(140);
      for (int i = 0; i < frames; ++i)
        EXPECT_EQ(judge_in(far, box_target(rest, Extent::modal)).verdict, Verdict::visible)
            << "no robot is near";
      const Judgement covered = see(20, 36);
      EXPECT_EQ(covered.verdict, Verdict::partial);
      EXPECT_NEAR(covered.occluded, 0.6, share_rounding);
    }
}

/// Something stands 0.5 m before six tenths of the target. No robot is near.
TEST_F(ModalTargets, AreHiddenByOtherObjectsWhereTheirDepthIsExpected) {
  constexpr int seen_columns = 16;
  for (const bool others_hide : {true, false}) {
    memory = {};
    depth = behind;
    EXPECT_EQ(see(20, 120).verdict, Verdict::visible);
    TargetFrame frame = robot_from(140);
    frame.see(20 + seen_columns, 30, 80, 70, TargetFrame::wall - 0.5f);
    TargetView target = box_target({20, 40, seen_columns, 20}, Extent::modal);
    target.thresholds.others_hide = others_hide;
    const Judgement covered = judge_in(frame, target);
    EXPECT_EQ(covered.verdict, others_hide ? Verdict::partial : Verdict::visible);
    EXPECT_NEAR(covered.hidden_by_other.value(), 0.6, share_rounding);
    EXPECT_EQ(covered.inside, 800u);
    depth.reset();
    EXPECT_EQ(judge_in(frame, target).hidden_by_other, std::nullopt);
  }
}

/// Something comes before the target, a column in each frame.
TEST_F(ModalTargets, AreHiddenByWhatComesSlowly) {
  depth = behind;
  EXPECT_EQ(see(20, 140).verdict, Verdict::visible);
  for (int columns = width; columns > width / 2; --columns) {
    TargetFrame frame = robot_from(140);
    frame.see(20 + columns, 30, 120, 70, TargetFrame::wall - 0.5f);
    const Judgement judgement =
        judge_in(frame, box_target({20, 40, double(columns), 20}, Extent::modal));
    EXPECT_NEAR(judgement.hidden_by_other.value(), 1.0 - double(columns) / width, share_rounding);
  }
}

TEST_F(ModalTargets, OfKnownHeightKeepTheirDepthWhileTheyAreCut) {
  constexpr int rows = 20;
  const double height = rows * behind / TargetFrame::camera().intrinsics.fy();
  const auto judge_rows = [&](int seen, int robot) {  // the robot covers the rows from `robot` on
    TargetFrame frame;
    frame.add_robot(0, robot, TargetFrame::width, TargetFrame::height, 1.0f, 1);
    TargetView target = box_target({20, 40, width, double(seen)}, Extent::modal);
    target.height = height;
    target.thresholds.unknown_limit = 0.0;
    return judge_in(frame, target);
  };
  EXPECT_EQ(judge_rows(rows / 2, 50).verdict, Verdict::unknown) << "not seen whole";
  EXPECT_EQ(judge_rows(3 * rows, 110).verdict, Verdict::unknown) << "the wall is behind it";
  memory = {};
  EXPECT_EQ(judge_rows(rows, 110).verdict, Verdict::visible);
  ASSERT_TRUE(memory.depth);
  EXPECT_NEAR(*memory.depth, behind, share_rounding);
  const Judgement half = judge_rows(rows / 2, 50);  // its height alone says 4 m
  EXPECT_EQ(half.verdict, Verdict::partial);
  EXPECT_NEAR(half.occluded, 0.5, share_rounding);
  EXPECT_EQ(half.hidden_by_other, 0.0) << "the wall would hide it at 4 m";
  EXPECT_NEAR(*memory.depth, behind, share_rounding);
}

TEST_F(ModalTargets, ThatMoveAreBlamedRightlyWhereMotionIsKnown) {
  constexpr int robot = 100;
  EXPECT_EQ(see(20, robot).verdict, Verdict::visible);
  EXPECT_EQ(see(30, robot, 10.0).verdict, Verdict::visible);
  const Judgement half = see(80, robot, 50.0);
  EXPECT_EQ(half.verdict, Verdict::partial);
  EXPECT_NEAR(half.occluded, 0.5, share_rounding);
  EXPECT_EQ(half.unknown, 0);
}

TEST_F(ModalTargets, FirstSeenBesideTheRobotAreUnknown) {
  EXPECT_EQ(see(70, 100).verdict, Verdict::unknown);
  EXPECT_EQ(see(20, 100).verdict, Verdict::visible);
  EXPECT_EQ(see(60, 100).verdict, Verdict::visible) << "as wide and as high as before";
  depth = behind;
  EXPECT_EQ(see(20, 100).verdict, Verdict::visible);
  EXPECT_EQ(see(60, 100).verdict, Verdict::visible) << "all of it is seen";
}

TEST_F(ModalTargets, AreAsLargeAsTheirDepthSays) {
  const auto see_box = [&](double columns, double rows, double z, int robot) {
    TargetFrame frame = robot_from(robot);
    TargetView target = box_target({70, 40, columns, rows}, Extent::modal);
    target.expected_depth = z;
    target.thresholds.min_measured = 0;
    LabelledImages images = frame.images();
    images.evidence = Evidence::assumed_free;  // the wall would not move with the target
    images.measured = {};
    judge.begin(images);
    return judge.judge(target, memory);
  };
  EXPECT_EQ(see_box(40, 20, 2.0, 150).verdict, Verdict::visible);
  EXPECT_EQ(see_box(30, 20, 2.0, 100).verdict, Verdict::partial);
  EXPECT_EQ(see_box(30, 15, 2.67, 100).verdict, Verdict::visible) << "as small as farther away";
  const Judgement half = see_box(30, 30, 1.33, 100);
  EXPECT_EQ(half.verdict, Verdict::partial) << "as large as nearer";
  EXPECT_NEAR(half.occluded + half.unknown, 0.5, 0.03);
  EXPECT_EQ(see_box(30, 24, 2.0, 100).verdict, Verdict::unknown) << "too large: another object";
  EXPECT_EQ(see_box(30, 20, 2.0, 100).verdict, Verdict::unknown) << "nothing is known of its size";
}

TEST_F(ModalTargets, MissingPixelsAddToWhatIsHidden) {
  EXPECT_EQ(see(20, 100).verdict, Verdict::visible);
  TargetFrame frame = robot_from(50);
  const Judgement half = judge_in(frame, box_target({20, 40, 20, 20}, Extent::modal));
  EXPECT_NEAR(half.occluded, 0.25, share_rounding);
  EXPECT_NEAR(half.unknown, 0.25, share_rounding);
  EXPECT_NEAR(half.clear, 0.5, share_rounding);
}

/// It comes into the image, of which its border shows 10 of 40 columns, and goes behind the robot.
TEST_F(ModalTargets, OfWhichTheBorderCutsSomeAreNotKnownWhole) {
  for (const double motion : {0.0, 35.0}) {
    memory = {};
    const auto moved = [&] { return motion > 0 ? std::optional(motion) : std::nullopt; };
    EXPECT_EQ(see(-30, 100).verdict, Verdict::visible) << "no robot is near";
    EXPECT_EQ(see(5, 30, moved()).verdict, Verdict::unknown) << "25 of 40 columns are seen";
    EXPECT_EQ(see(5, 46, moved()).verdict, Verdict::unknown) << "nor is it known that this is all";
    EXPECT_EQ(see(5, 120, moved()).verdict, Verdict::visible) << "clear of border and robot";
    EXPECT_EQ(see(5, 46, 0.0).verdict, Verdict::visible);
    EXPECT_EQ(see(5, 30, 0.0).verdict, Verdict::partial);
  }
}

/// A rectified image whose left part the camera did not see.
TEST_F(ModalTargets, AreCutWhereTheCameraSawNothing) {
  depth = behind;
  Image<std::uint8_t> unseen(TargetFrame::width, TargetFrame::height);
  for (int v = 0; v < TargetFrame::height; ++v)
    for (int u = 0; u < 20 + v / 60; ++u) unseen(u, v) = 1;
  for (const int first : {15, 30}) {
    judge = TargetJudge(TargetFrame::camera(), TargetFrame::without_cleanup(), 3, unseen.view());
    EXPECT_EQ(see(first, 140).verdict, Verdict::visible);
    EXPECT_EQ(see(60, 100).verdict, first == 30 ? Verdict::visible : Verdict::unknown) << first;
  }
}

}  // namespace
}  // namespace penumbra::test
