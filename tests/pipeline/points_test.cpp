// SPDX-License-Identifier: Apache-2.0
// Points of depth images: a slanted wall, and the points that a rule leaves of it.
#include "../support/test.hpp"

#include <penumbra/pipeline/without_robot.hpp>

namespace penumbra::test {
namespace {

constexpr int width = 64, height = 48;
const Intrinsics intrinsics(width, height, 60.0, 60.0, 31.5, 23.5);
const Camera pinhole{intrinsics, {}, {}, {}};

/// From 1 m on the left to 3 m on the right; nothing in the first row.
DepthImage wall() {
  Image<float> image(width, height);
  for (const auto [u, v] : each_pixel(0, 0, width, height))
    image(u, v) = v == 0 ? 0.0F : 1.0F + 2.0F * float(u) / width;
  return image;
}

PointCloud points_of(const PointsRule& rule, const Isometry3d& T = Isometry3d::Identity()) {
  PointCloud cloud;
  CloudMaker maker(pinhole, rule);
  for (int again = 0; again < 2; ++again) maker.make(wall(), cloud, T);
  return cloud;
}

std::array<int, 3> cube_of(const Vector3f& point, double size) {
  const Eigen::Array3d at = (point.cast<double>().array() / size).floor();
  return {int(at.x()), int(at.y()), int(at.z())};
}

TEST(Points, AreThoseOfAllMeasuredPixels) {
  const PointCloud cloud = points_of({});
  ASSERT_EQ(cloud.points.size(), std::size_t(width * (height - 1)));
  EXPECT_EQ(cloud.pixels.front(), std::uint32_t(width));
  EXPECT_FLOAT_EQ(cloud.points.front().z(), 1.0F);
  EXPECT_FLOAT_EQ(cloud.points.front().x(), -31.5F / 60.0F);
}

TEST(Points, AreThoseOfEachNthPixelWithinTheRange) {
  const PointCloud all = points_of({});
  std::vector<std::uint32_t> of_stride, of_range;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const std::uint32_t pixel = all.pixels[i];
    if (pixel % width % 3 == 0 && pixel / width % 3 == 0) of_stride.push_back(pixel);
    if (all.points[i].norm() <= 2.0F) of_range.push_back(pixel);
  }
  EXPECT_EQ(points_of({.stride = 3}).pixels, of_stride);
  EXPECT_EQ(points_of({.range = 2.0}).pixels, of_range);
  EXPECT_LT(of_range.size(), all.points.size());
}

TEST(Points, OfVoxelsAreTheFirstOfEachCube) {
  Isometry3d T(AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  T.translation() = Vector3d(-5, 7, 0.3);
  for (const Isometry3d& frame : {Isometry3d::Identity(), T})
    for (const double size : {0.01, 0.1, 5.0}) {
      const PointCloud all = points_of({}, frame), some = points_of({.voxel = size}, frame);
      std::set<std::array<int, 3>> cubes;
      std::vector<std::uint32_t> expected;
      for (std::size_t i = 0; i < all.points.size(); ++i)
        if (cubes.insert(cube_of(all.points[i], size)).second) expected.push_back(all.pixels[i]);
      EXPECT_EQ(some.pixels, expected) << size;
    }
}

TEST(Points, AreRefusedForARuleOutOfRange) {
  EXPECT_THROW(CloudMaker(pinhole, {.stride = 0}), InputError);
  EXPECT_THROW(CloudMaker(pinhole, {.range = -1.0}), InputError);
  EXPECT_THROW(CloudMaker(pinhole, {.voxel = nan}), InputError);
  EXPECT_THROW(CloudMaker(pinhole, {.voxel = 1e-30}), InputError);
}

}  // namespace
}  // namespace penumbra::test
