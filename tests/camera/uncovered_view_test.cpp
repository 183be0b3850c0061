// SPDX-License-Identifier: Apache-2.0
// What the pinhole image of a raw one leaves out, against points all over boxes.
#include "../support/random.hpp"
#include "../support/run_length.hpp"

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
  const auto draw = [&random](auto& distribution) {  // braces draw in order, for every compiler
    return Vector3d{distribution(random), distribution(random), distribution(random)};
  };
  const Camera camera = one_sided_fisheye();
  const UncoveredView uncovered(camera, Rectification(camera));
  int held = 0, free = 0;
  for (int i = 0; i < samples(30000); ++i) {
    const Vector3d axis = draw(place).normalized();
    Eigen::Isometry3d pose(Eigen::AngleAxisd(2.0 * place(random), axis));
    pose.translation() = draw(place);
    const Vector3d half =
        Vector3d::Constant(0.02) + draw(share).cwiseProduct(Vector3d(1.0, 1.5, 0.1));
    const Eigen::AlignedBox3d box(-half, half);
    const bool is_held = uncovered.holds_part_of(box, pose);
    (is_held ? held : free) += 1;
    for (int k = 0; k < 200; ++k) {
      Vector3d point = 2.0 * draw(share) - Vector3d::Ones();
      point[k % 3] = k % 2 == 0 ? 1.0 : -1.0;  // of the surface
      if (uncovered.holds(pose * point.cwiseProduct(half))) {
        ASSERT_TRUE(is_held) << "box " << i;
      }
    }
  }
  EXPECT_GT(held, samples(3000));
  EXPECT_GT(free, samples(3000));
}

/// Beside the camera, from behind it to far before it: seen on a side where all its edges are
/// covered.
TEST(UncoveredView, HoldsAPlateThatTheAxisMeetsBehindTheCamera) {
  const Camera camera = one_sided_fisheye();
  const UncoveredView uncovered(camera, Rectification(camera));
  const Eigen::AlignedBox3d plate(Vector3d(-1.5, -5, -0.001), Vector3d(4, 5, 0.001));
  // Along the plate's x axis it goes forwards, and to the uncovered side.
  Eigen::Isometry3d pose(Eigen::AngleAxisd(-1.3, Vector3d::UnitY()));
  pose.translation() = Vector3d(0, 0, -0.3);
  ASSERT_TRUE(uncovered.holds(pose * Vector3d(0.32, 0, 0)));
  EXPECT_TRUE(uncovered.holds_part_of(plate, pose));
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
