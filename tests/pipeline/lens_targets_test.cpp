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
  const Target target{.name = "plate", .shape = BoxTarget{pose, size, {}}};
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

}  // namespace
}  // namespace penumbra::test
