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

TEST(TargetPoints, UndoLensDistortion) {
  TargetFrame frame;
  Camera camera = TargetFrame::camera();
  const std::array coefficients = {-0.2, 0.05, 0.001, -0.002, 0.0};
  camera.distortion = Distortion("plumb_bob", coefficients);
  TargetJudge judge(camera, frame.rule, 3);
  judge.begin(frame.images());
  const Eigen::Vector2d truth(-0.31, 0.22);  // on the plane z = 1
  const Eigen::Vector2d lens = camera.distortion.distort(truth);
  TargetView target = box_target({20, 80, 30, 30});
  target.point_pixel = camera.intrinsics.project({lens.x(), lens.y(), 1.0});
  const Judgement judgement = judge.judge(target);
  ASSERT_TRUE(judgement.point);
  EXPECT_LT((*judgement.point - 2.0 * Eigen::Vector3d(truth.x(), truth.y(), 1)).norm(), metres);
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

}  // namespace
}  // namespace penumbra
