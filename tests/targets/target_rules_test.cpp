// SPDX-License-Identifier: Apache-2.0
// Verdicts and points of targets on scenes in closed form.
#include "target_frame.hpp"

namespace penumbra::test {
namespace {

TEST(Judging, NoLimitMakesWhatIsUnknownVisible) {
  TargetFrame frame;
  frame.add_robot(40, 40, 60, 60, 1.0f, 1, false);
  frame.see(40, 40, 60, 60, hole);
  TargetView target = box_target(middle_box);
  target.thresholds.unknown_limit = 1;
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::unknown);
  frame.see(40, 40, 60, 50, 0.8f);
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::unknown) << "half of it";
  frame.see(40, 50, 60, 51, 0.8f);
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::visible);
  frame.see(40, 40, 60, 46, 1.0f);
  frame.see(40, 46, 60, 60, hole);
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::unknown) << "partial: none of it is seen";
}

/// A target of 100 columns of which the robot hides some.
TEST(Verdicts, TooMuchUnknownIsUnknownUnlessTheRestDecides) {
  const auto verdict = [](int hidden_columns, int unknown_columns) {
    TargetFrame frame;
    frame.add_robot(40, 40, 40 + hidden_columns, 60, 1.0f, 1);
    frame.add_robot(40 + hidden_columns, 40, 40 + hidden_columns + unknown_columns, 60, 1.0f, 1);
    frame.see(40 + hidden_columns, 40, 40 + hidden_columns + unknown_columns, 60, hole);
    return judge_once(frame, box_target(middle_box)).verdict;
  };
  EXPECT_EQ(verdict(0, 1), Verdict::visible);  // 5 %, the limit
  EXPECT_EQ(verdict(0, 2), Verdict::unknown);
  EXPECT_EQ(verdict(4, 6), Verdict::partial);   // 20 % to 50 %: partial either way
  EXPECT_EQ(verdict(4, 15), Verdict::unknown);  // to 95 %: perhaps hidden
  EXPECT_EQ(verdict(19, 1), Verdict::hidden);
  EXPECT_EQ(verdict(0, 20), Verdict::unknown);
}

/// e(1.5 m) = 0.0265 m.
TEST(Verdicts, HoldOnlyForWhatIsSeenWhereItIsExpected) {
  TargetFrame frame;  // the wall is at 2 m
  TargetView target = box_target(middle_box);
  target.expected_depth = 1.5;
  frame.see(40, 40, 60, 50, 1.526f);
  EXPECT_TRUE(judge_once(frame, target).reason.starts_with("the sensor looks past"));
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::unknown) << "half against half";
  frame.see(40, 50, 41, 51, 1.526f);
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::visible) << "less than the limit";
  frame.see(40, 51, 60, 60, 0.5f);
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::partial) << "hidden by another object";
  target.thresholds.others_hide = false;
  EXPECT_EQ(judge_once(frame, target).verdict, Verdict::visible);
}

/// The tolerance of a stereo camera, 0.006 z^2, exceeds z from 167 m on.
TEST(Verdicts, WhatIsSaidToBeFarAwayIsHiddenAsWell) {
  TargetFrame frame;  // the wall is at 2 m
  TargetView target = box_target(middle_box);
  for (const double depth : {20.0, 100.0, 187.0, 1870.0}) {
    target.expected_depth = depth;
    frame.add_robot(40, 40, 60, 60, 1.0f, 1);
    EXPECT_EQ(judge_once(frame, target).occluded, 1.0) << depth;
    TargetFrame bare;
    EXPECT_EQ(judge_once(bare, target).hidden_by_other, 1.0) << depth;
  }
}

Verdict verdict_of(TargetJudge& judge, int hidden, TargetMemory& memory,
                   const TargetThresholds& thresholds = {}) {
  TargetFrame frame;
  frame.add_robot(20, 0, 20 + hidden, TargetFrame::height, 1.0f, 1);
  TargetView target = box_target({20, 40, 100, 20});
  target.thresholds = thresholds;
  judge.begin(frame.images());
  return judge.judge(target, memory).verdict;
}

TEST(Verdicts, HaveHysteresis) {
  TargetJudge judge(TargetFrame::camera(), TargetFrame::without_cleanup(), 3);
  TargetMemory memory;
  const std::pair<int, Verdict> sequence[] = {
      {0, Verdict::visible}, {5, Verdict::visible},  {6, Verdict::partial},  {5, Verdict::partial},
      {4, Verdict::visible}, {5, Verdict::visible},  {90, Verdict::partial}, {91, Verdict::hidden},
      {81, Verdict::hidden}, {80, Verdict::partial}, {90, Verdict::partial}, {91, Verdict::hidden},
      {5, Verdict::partial}, {91, Verdict::hidden},  {4, Verdict::visible},  {91, Verdict::hidden}};
  for (const auto& [hidden, verdict] : sequence)
    EXPECT_EQ(verdict_of(judge, hidden, memory), verdict) << hidden;
  memory = {};
  EXPECT_EQ(verdict_of(judge, 85, memory), Verdict::partial);
}

TEST(Verdicts, RememberPastUnknown) {
  TargetJudge judge(TargetFrame::camera(), TargetFrame::without_cleanup(), 3);
  TargetMemory memory;
  EXPECT_EQ(verdict_of(judge, 95, memory), Verdict::hidden);
  TargetFrame frame;
  judge.begin({frame.images().labels, {}, {}, Evidence::none});
  EXPECT_EQ(judge.judge(box_target(middle_box), memory).verdict, Verdict::unknown);
  EXPECT_EQ(verdict_of(judge, 85, memory), Verdict::hidden);
}

TEST(Verdicts, OutOfView) {
  TargetFrame frame;
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  const Judgement away = judge.judge(box_target({1000, 0, 20, 20}));
  EXPECT_EQ(away.verdict, Verdict::out_of_view);
  EXPECT_EQ(away.covered, 400u);
  EXPECT_EQ(away.inside, 0u);
  EXPECT_EQ(away.clear + away.front + away.occluded + away.unknown, 0);
  TargetView edge = box_target({-15, 0, 20, 20});
  edge.thresholds.min_inside = 0.25;
  EXPECT_EQ(judge.judge(edge).verdict, Verdict::out_of_view);
  edge.thresholds.min_inside = 0.24;
  EXPECT_EQ(judge.judge(edge).verdict, Verdict::visible);
  const Image<float> nothing(TargetFrame::width, TargetFrame::height);
  TargetView rendered = box_target(middle_box);
  rendered.region = RenderedRegion{nothing.view(), nullptr};
  EXPECT_EQ(judge.judge(rendered).verdict, Verdict::out_of_view);
}

constexpr double metres = 1e-6;  // float32 near 2 m

TEST(TargetPoints, UndoLensDistortion) {
  TargetFrame frame;
  Camera camera = TargetFrame::camera();
  camera.distortion = Distortion("plumb_bob", std::array{-0.2, 0.05, 0.001, -0.002, 0.0});
  TargetJudge judge(camera, frame.rule, 3);
  judge.begin(frame.images());
  const Vector2d truth(-0.31, 0.22);  // on the plane z = 1
  const Vector2d lens = camera.distortion.distort(truth);
  TargetView target = box_target({20, 80, 30, 30});
  target.point_pixel = camera.intrinsics.project({lens.x(), lens.y(), 1.0});
  const Judgement judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  EXPECT_LT((*judgement.point - 2.0 * Vector3d(truth.x(), truth.y(), 1)).norm(), metres);
}

TEST(TargetPoints, NeedEnoughTrustedPixels) {
  TargetFrame frame;
  std::fill_n(frame.measured.data(), frame.measured.size(), 0.0f);
  frame.see(40, 40, 44, 60, 1.0f);  // 80 of 400
  TargetJudge judge(TargetFrame::camera(), frame.rule, 3);
  judge.begin(frame.images());
  TargetView target = box_target({40, 40, 20, 20});
  EXPECT_TRUE(judge.judge(target).point);
  target.thresholds.point_min_fraction = 0.201;
  EXPECT_FALSE(judge.judge(target).point);
  target.thresholds.point_min_fraction = 0;
  target.thresholds.point_min_pixels = 81;
  EXPECT_FALSE(judge.judge(target).point);
  target.thresholds.point_min_pixels = 0;
  target.region = PixelBox{70, 70, 5, 5};
  EXPECT_FALSE(judge.judge(target).point);
}

// What regions cover: shared edges and sizes. Which pixels those are is asked of geometry in
// target_oracle_test.cpp.

using Corners = std::vector<Vector2d>;

class Regions : public testing::Test {
 protected:
  Judgement judge(const Region& region) {
    TargetView target;
    target.region = region;
    judge_.begin(frame_.images());
    return judge_.judge(target);
  }

  static constexpr std::size_t all = std::size_t{TargetFrame::width} * TargetFrame::height;
  TargetFrame frame_;
  TargetJudge judge_{TargetFrame::camera(), frame_.rule, 3};
};

TEST_F(Regions, PolygonsOnTheGridThatShareEdgesShareNoPixel) {
  auto random = seeded_random(41);
  const auto grid = [&](double low, double high) {
    return std::round(std::uniform_real_distribution<double>(low, high)(random));
  };
  for (int i = 0; i < 100; ++i) {
    // A frame of four corners cut into triangles at a point of it: each pixel is in one of them.
    const Corners frame = {{grid(-9, 5), grid(-9, 5)},
                           {grid(50, 170), grid(-9, 5)},
                           {grid(50, 170), grid(40, 130)},
                           {grid(-9, 5), grid(40, 130)}};
    const Vector2d middle(grid(10, 45), grid(10, 35));
    const Judgement whole = judge(PixelPolygon{frame});
    std::size_t inside = 0, covered = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Corners part = {frame[k], frame[(k + 1) % 4], middle};
      const Judgement judged = judge(PixelPolygon{part});
      inside += judged.inside;
      covered += judged.covered;
    }
    EXPECT_EQ(inside, whole.inside);
    EXPECT_EQ(covered, whole.covered);
  }
}

TEST_F(Regions, LargeOnesCountByTheirArea) {
  // Of 256 rows above and 256 below the image the midpoint rule misses less than a row's share of
  // the triangle's height.
  constexpr double sampled = 1.0 / 256;
  constexpr double tolerance = 1e-9;  // rounding to whole pixels
  const double disc = std::numbers::pi * 2e10;
  const Corners triangle = {{-1e6, -1e6}, {1e6, -1e6}, {0, 2e6}};
  const Corners bow = {{-1e6, -1e6}, {1e6, 1e6}, {1e6, -1e6}, {-1e6, 1e6}};  // nothing cancels
  struct Case {
    Region region;
    double covered;
    std::size_t inside;
    double tolerance;
  };
  for (const Case& each : std::initializer_list<Case>{
           {PixelBox{-1e9, -1e9, 1e9, 1e9}, 1e18, 0, tolerance},
           {PixelEllipse{{20, 30}, {1e5, 2e5}, 0.4}, disc, all, tolerance},
           {PixelEllipse{{20, 1e6}, {1e5, 2e5}, 0}, disc, 0, tolerance},
           {PixelPolygon{triangle}, 3e12, all, sampled},
           {PixelPolygon{bow}, 2e12, judge(PixelPolygon{bow}).inside, sampled}}) {
    const Judgement judged = judge(each.region);
    EXPECT_NEAR(double(judged.covered) / each.covered, 1, each.tolerance);
    EXPECT_EQ(judged.inside, each.inside);
  }
}

TEST_F(Regions, CoverOnePixelAtLeast) {
  const Corners small = {{10.2, 10.2}, {10.4, 10.2}, {10.3, 10.4}};
  const Region regions[] = {PixelBox{10.2, 10.2, 0.3, 0.3}, PixelPolygon{small},
                            PixelEllipse{{10.3, 10.3}, {0.1, 0.1}, 0}};
  for (const Region& one : regions) {
    EXPECT_EQ(judge(one).covered, 1u);
    EXPECT_EQ(judge(one).inside, 1u);
  }
  const Judgement outside = judge(PixelEllipse{{-0.6, 3}, {0.1, 0.1}, 0});
  EXPECT_EQ(outside.covered, 1u);
  EXPECT_EQ(outside.inside, 0u);
}

}  // namespace
}  // namespace penumbra::test
