// SPDX-License-Identifier: Apache-2.0
// What the pinhole image of a raw one leaves out, against points all over boxes.
#include "../support/random.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <penumbra/camera/uncovered_view.hpp>

namespace penumbra::test {
namespace {

using Eigen::Vector3d;

/// A fisheye that sees far to one side: only there pixels are not covered.
Camera one_sided_fisheye() {
  const double coefficients[] = {0, 0, 0, 0};
  return {.intrinsics = Intrinsics(160, 120, 60.0, 60.0, 45.0, 60.0),
          .distortion = Distortion("equidistant", coefficients),
          .range = {},
          .frame_id = {}};
}

TEST(UncoveredView, HoldsWhatAnyPointOfABoxIsSeenIn) {
  std::mt19937_64 random = seeded_random(31);
  std::uniform_real_distribution<double> place(-2.0, 2.0), share(0.0, 1.0);
  const Camera camera = one_sided_fisheye();
  const UncoveredView uncovered(camera, Rectification(camera));
  int held = 0, free = 0;
  for (int i = 0; i < 3000; ++i) {
    Eigen::Isometry3d pose(
        Eigen::Quaterniond(place(random), place(random), place(random), place(random))
            .normalized());
    pose.translation() = Vector3d(place(random), place(random), place(random));
    const Vector3d half =
        0.02 * Vector3d::Ones() + Vector3d(share(random), 1.5 * share(random), 0.1 * share(random));
    const Eigen::AlignedBox3d box(-half, half);
    const bool is_held = uncovered.holds_part_of(box, pose);
    (is_held ? held : free) += 1;
    for (int k = 0; k < 200; ++k) {
      Vector3d point;
      for (double& x : point) x = 2.0 * share(random) - 1.0;
      point[k % 3] = k % 2 == 0 ? 1.0 : -1.0;  // of the surface
      if (uncovered.holds(pose * point.cwiseProduct(half))) {
        ASSERT_TRUE(is_held) << "box " << i;
      }
    }
  }
  EXPECT_GT(held, 300);
  EXPECT_GT(free, 300);
}

TEST(UncoveredView, IsEmptyWhereAllIsCovered) {
  const double coefficients[] = {0, 0, 0, 0};
  const Camera camera{.intrinsics = Intrinsics(160, 120, 150.0, 150.0, 80.0, 60.0),
                      .distortion = Distortion("equidistant", coefficients),
                      .range = {},
                      .frame_id = {}};
  const UncoveredView uncovered(camera, Rectification(camera));
  EXPECT_FALSE(uncovered.holds({1, 0, -1}));
  const Eigen::AlignedBox3d around(Vector3d::Constant(-1), Vector3d::Constant(1));
  EXPECT_FALSE(uncovered.holds_part_of(around, Eigen::Isometry3d::Identity()));
}

}  // namespace
}  // namespace penumbra::test
