// SPDX-License-Identifier: Apache-2.0
// Points of targets in closed form, and that none is of the robot's body.
#include "../support/random.hpp"
#include "target_frame.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace penumbra {
namespace {

using test::box_target;
using test::TargetFrame;

constexpr double metres = 1e-6;  // float32 near 2 m

TEST(TargetPoints, AreOnThePlaneThatIsSeen) {
  TargetFrame frame;
  frame.see(40, 30, 61, 51, 0.75f);
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  TargetView target = box_target("cup", {40, 30, 21, 21});
  Judgement judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  const Eigen::Vector3d truth = 0.75 * TargetFrame::camera().intrinsics.ray(50, 40);
  EXPECT_LT((*judgement.point - truth).norm(), metres);
  EXPECT_EQ(judgement.point_pixels, 441u);
  EXPECT_EQ(judgement.point_spread, 0.0);
  target.name = "corner";
  target.point_pixel = {40.5, 30.25};
  judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  const Eigen::Vector3d corner = 0.75 * TargetFrame::camera().intrinsics.ray(40.5, 30.25);
  EXPECT_LT((*judgement.point - corner).norm(), metres);
}

TEST(TargetPoints, UndoLensDistortion) {
  TargetFrame frame;
  Camera camera = TargetFrame::camera();
  const std::array coefficients = {-0.2, 0.05, 0.001, -0.002, 0.0};
  camera.distortion = Distortion("plumb_bob", coefficients);
  TargetJudge judge(camera, frame.rule, 3);
  judge.begin(frame.images());
  const Eigen::Vector2d truth(-0.31, 0.22);  // on the plane z = 1
  const Eigen::Vector2d lens = camera.distortion.distort(truth);
  TargetView target = box_target("cup", {20, 80, 30, 30});
  target.point_pixel = camera.intrinsics.project({lens.x(), lens.y(), 1.0});
  const Judgement judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  EXPECT_LT((*judgement.point - 2.0 * Eigen::Vector3d(truth.x(), truth.y(), 1)).norm(), metres);
}

TEST(TargetPoints, AreMediansWithTheirSpread) {
  TargetFrame frame;
  auto random = test::seeded_random(43);
  constexpr double sigma = 0.004;
  std::normal_distribution<double> noise(1.2, sigma);
  for (int v = 20; v < 80; ++v)
    for (int u = 20; u < 80; ++u) frame.measured(u, v) = static_cast<float>(noise(random));
  frame.see(20, 20, 80, 35, 0.4f);  // a quarter is something else
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  TargetView target = box_target("cup", {20, 20, 60, 60});
  target.expected_depth = 1.2;
  target.thresholds.others_hide = false;
  const Judgement judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  // One pixel in four is asked. Five standard errors of 675 values: of a median 1.25 sigma /
  // sqrt(n), of a MAD about as much.
  constexpr double error = 5 * 1.25 * sigma / 26;
  EXPECT_NEAR(judgement.point->z(), 1.2, error);
  EXPECT_NEAR(judgement.point_spread, sigma, error);
  constexpr double missed = 60;  // one pixel in each of the 60 rows
  EXPECT_NEAR(static_cast<double>(judgement.point_pixels), 2700, missed);
}

TEST(TargetPoints, LeaveOutWhatIsNotAsFarAsExpected) {
  TargetFrame frame;
  frame.see(40, 40, 51, 60, 1.0f);  // the others are of the wall
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  TargetView target = box_target("cup", {40, 40, 20, 20});
  target.expected_depth = 1.01;
  Judgement judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  EXPECT_NEAR(judgement.point->z(), 1.0, metres);
  EXPECT_EQ(judgement.point_pixels, 220u);
  target.name = "elsewhere";
  target.expected_depth = 1.5;
  target.thresholds.others_hide = false;
  judgement = judge.judge(target);
  EXPECT_FALSE(judgement.point);
}

TEST(TargetPoints, NeedEnoughTrustedPixels) {
  TargetFrame frame;
  std::fill_n(frame.measured.data(), frame.measured.size(), 0.0f);
  frame.see(40, 40, 44, 60, 1.0f);  // 80 of 400
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  TargetView target = box_target("cup", {40, 40, 20, 20});
  EXPECT_TRUE(judge.judge(target).point);
  target.name = "fraction";
  target.thresholds.point_min_fraction = 0.201;
  EXPECT_FALSE(judge.judge(target).point);
  target.name = "pixels";
  target.thresholds.point_min_fraction = 0;
  target.thresholds.point_min_pixels = 81;
  EXPECT_FALSE(judge.judge(target).point);
  target.name = "hole";
  target.thresholds.point_min_pixels = 0;
  target.region = PixelBox{70, 70, 5, 5};
  EXPECT_FALSE(judge.judge(target).point);
}

TEST(TargetPoints, AreNotOfTheRobotsBody) {
  // The sensor sees the robot six pixels wider than the model, at its depth and a little beyond.
  for (const float seen : {1.0f, 0.98f, 1.04f}) {
    TargetFrame frame;
    frame.add_robot(60, 0, 100, TargetFrame::height, 1.0f, 1);
    frame.see(54, 0, 106, TargetFrame::height, seen);
    TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
    judge.begin(frame.images());
    TargetView target = box_target("wrist", {54, 40, 6, 6});
    target.region = PixelEllipse{{56, 40}, {3, 3}, 0};
    const Judgement judgement = judge.judge(target);
    EXPECT_EQ(judgement.verdict, Verdict::visible);
    EXPECT_FALSE(judgement.point) << seen;
  }
}

TEST(TargetPoints, OfThingsBeforeOrBehindTheRobotAreKept) {
  for (const float seen : {0.7f, 1.3f}) {
    TargetFrame frame;
    frame.add_robot(60, 0, 100, TargetFrame::height, 1.0f, 1);
    frame.see(45, 30, 60, 60, seen);
    TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
    judge.begin(frame.images());
    const Judgement judgement = judge.judge(box_target("cup", {50, 40, 10, 10}));
    ASSERT_TRUE(judgement.point) << seen;
    EXPECT_NEAR(judgement.point->z(), static_cast<double>(seen), metres);
  }
}

TEST(TargetPoints, OfAHandBeforeTheArmAreTheHands) {
  TargetFrame frame{LabelRule{}};
  frame.add_robot(40, 0, 120, TargetFrame::height, 1.0f, 1);
  frame.see(60, 40, 90, 70, 0.8f);
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  const Judgement judgement = judge.judge(box_target("hand", {65, 45, 20, 20}));
  EXPECT_EQ(judgement.verdict, Verdict::visible);
  EXPECT_EQ(judgement.front, 1.0);
  ASSERT_TRUE(judgement.point);
  EXPECT_NEAR(judgement.point->z(), 0.8, metres);
}

TEST(TargetPoints, AreNotGivenWhereTheRobotHides) {
  TargetFrame frame;
  frame.add_robot(40, 40, 60, 58, 1.0f, 1);
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  TargetView target = box_target("cup", {40, 40, 20, 20});
  target.thresholds.hidden_enter = 0.85;
  target.thresholds.point_min_fraction = 0;
  const Judgement judgement = judge.judge(target);
  EXPECT_EQ(judgement.verdict, Verdict::hidden);
  EXPECT_FALSE(judgement.point);
}

TEST(TargetPoints, OfMillimetresAreThoseOfMetres) {
  TargetFrame frame;
  Image<std::uint16_t> depth(TargetFrame::width, TargetFrame::height, 1234);
  LabelledImages images = frame.images();
  images.measured = depth.view();
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(images);
  const Judgement judgement = judge.judge(box_target("cup", {40, 40, 20, 20}));
  ASSERT_TRUE(judgement.point);
  EXPECT_NEAR(judgement.point->z(), 1.234, metres);
}

}  // namespace
}  // namespace penumbra
