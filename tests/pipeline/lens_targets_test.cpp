// SPDX-License-Identifier: Apache-2.0
#include "targets_fixture.hpp"

#include <cmath>

namespace penumbra::test {
namespace {

/// In the raw image of a lens a rendered box covers the pixels whose rays meet it, and the robot
/// hides those whose rays meet the robot.
TEST(TargetsInTheRawImage, OfARenderedBoxAreThoseThatTheirRaysMeet) {
  Camera camera = slab_camera();
  const double coefficients[] = {-0.25, 0.06, 0.001, -0.001, 0.0};
  camera.distortion = Distortion("plumb_bob", coefficients);
  const Image<float> depth = scene_depth(camera, 0.0);
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const Eigen::Vector3d middle(0.40, 0.05, 1.5), size(0.6, 0.5, 0.001);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = middle;
  Target target{.name = "plate", .shape = BoxTarget{pose, size, {}}};
  target.thresholds.past_limit = 1;  // the wall is what is measured
  const std::vector<double> positions{0.0};
  const FrameReport& report = pipeline.process(
      {.stamp = 1, .depth = depth.view(), .joints = positions, .targets = {&target, 1}});
  int covered = 0, hidden = 0;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      const Eigen::Vector3d straight = camera.intrinsics.ray(u, v);
      const auto ray = camera.distortion.undistort(straight.head<2>());
      if (!ray) continue;
      const Eigen::Vector2d off = 1.4995 * *ray - middle.head<2>();
      if (std::abs(off.x()) > size.x() / 2 || std::abs(off.y()) > size.y() / 2) continue;
      ++covered;
      if (cast({ray->x(), ray->y(), 1.0}, 0.0).depth > 0.0) ++hidden;
    }
  }
  // Raw images are drawn through the pinhole image: outlines may be off by a pixel.
  const TargetReport& plate = report.targets[0];
  ASSERT_TRUE(plate.judgement) << plate.reason;
  constexpr double outline = 0.04;  // of the plate's pixels
  EXPECT_GT(covered, 1500);
  EXPECT_GT(hidden, 300);
  EXPECT_NEAR(static_cast<double>(plate.judgement->inside), covered, outline * covered);
  EXPECT_NEAR(plate.judgement->occluded, hidden / (1.0 * covered), outline);
  EXPECT_EQ(plate.verdict, Verdict::partial);
}

/// A lens whose pinhole image reaches far beyond what the camera saw.
class RectifiedTargetsTest : public testing::Test {
 protected:
  RectifiedTargetsTest() : camera_(slab_camera()) {
    const double coefficients[] = {-0.3, 0.0, 0.0, 0.0, 0.0};
    camera_.distortion = Distortion("plumb_bob", coefficients);
    depth_ = Image<float>(camera_.intrinsics.width(), camera_.intrinsics.height(),
                          static_cast<float>(wall_depth));
  }

  [[nodiscard]] Pipeline pipeline(ImageSpace image) const {
    PipelineConfig config = plain_config();
    config.image = image;
    return {slab_robot(), camera_, config};
  }

  TargetReport judge(Pipeline& pipeline, const Target& target) const {
    const std::vector<double> positions{0.0};
    return pipeline
        .process({.stamp = 1, .depth = depth_.view(), .joints = positions, .targets = {&target, 1}})
        .targets[0];
  }

  Camera camera_;
  Image<float> depth_;
};

TEST_F(RectifiedTargetsTest, WhereTheCameraSawNothingAreOutOfView) {
  Pipeline rectified = pipeline(ImageSpace::rectified);
  const auto to_raw = rectified.rectification()->pinhole_to_raw();
  int seen_rows = 0;  // of the left edge's pixels, those that the camera saw
  while (to_raw(0, seen_rows) != Rectification::no_pixel) ++seen_rows;
  ASSERT_EQ(seen_rows, 0) << "the corner is black";
  int seen_columns = 0;  // up to which the first row is black
  while (to_raw(seen_columns, 0) == Rectification::no_pixel) ++seen_columns;
  ASSERT_GT(seen_columns, 3);
  const TargetReport black =
      judge(rectified, region("black", PixelBox{0, 0, 1.0 * seen_columns, 1}));
  EXPECT_EQ(black.verdict, Verdict::out_of_view);
  ASSERT_TRUE(black.judgement);
  EXPECT_EQ(black.judgement->inside, 0U);
  EXPECT_EQ(black.judgement->covered, static_cast<std::size_t>(seen_columns));
  EXPECT_EQ(black.judgement->clear, 0.0);
}

TEST_F(RectifiedTargetsTest, AtItsEdgeAreJudgedByWhatTheCameraSaw) {
  Pipeline rectified = pipeline(ImageSpace::rectified);
  const auto to_raw = rectified.rectification()->pinhole_to_raw();
  const PixelBox whole{0, 0, 1.0 * to_raw.width, 1.0 * to_raw.height};
  const TargetReport all = judge(rectified, region("all", whole));
  ASSERT_TRUE(all.judgement);
  std::size_t seen = 0;
  for (int v = 0; v < to_raw.height; ++v)
    for (int u = 0; u < to_raw.width; ++u) seen += to_raw(u, v) >= 0 ? 1 : 0;
  EXPECT_LT(seen, all.judgement->covered);
  EXPECT_EQ(all.judgement->inside, seen);
}

TEST_F(RectifiedTargetsTest, AreInViewWhereTheyAreInTheRawImage) {
  Pipeline raw = pipeline(ImageSpace::raw), rectified = pipeline(ImageSpace::rectified);
  int in_view = 0, out_of_view = 0;
  for (double x = -1.5; x <= 1.5; x += 0.125) {
    for (double y = -1.2; y <= 1.2; y += 0.125) {
      const auto is_seen = [&](Pipeline& by, double scale) {
        const Eigen::Vector3d position(scale * x, scale * y, 1.0);
        by.forget_targets();
        const Target target{.name = "point", .shape = PointTarget{position, 0.002, {}}};
        return judge(by, target).verdict != Verdict::out_of_view;
      };
      const bool in_raw = is_seen(raw, 1.0);
      if (is_seen(raw, 0.98) != is_seen(raw, 1.02)) continue;  // within two pixels of the edge
      EXPECT_EQ(is_seen(rectified, 1.0), in_raw) << x << ", " << y;
      (in_raw ? in_view : out_of_view) += 1;
    }
  }
  EXPECT_GT(in_view, 50);
  EXPECT_GT(out_of_view, 50);
}

}  // namespace
}  // namespace penumbra::test
