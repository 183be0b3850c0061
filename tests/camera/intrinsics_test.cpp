// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"

#include <penumbra/camera/camera.hpp>

namespace penumbra::test {
namespace {

TEST(Intrinsics, PixelCentresAreAtIntegers) {
  const Intrinsics camera(640, 480, 500, 510, 320, 240);
  EXPECT_EQ(camera.ray(320, 240), Vector3d(0, 0, 1));
  EXPECT_EQ(camera.ray(820, -270), Vector3d(1, -1, 1));
  EXPECT_EQ(camera.project({0.5, 1.0, 2.0}), Vector2d(445, 495));
}

TEST(Intrinsics, RefusesWhatIsNoCamera) {
  constexpr int most = Intrinsics::max_size;
  EXPECT_NO_THROW(Intrinsics(1, 1, 1e-3, Intrinsics::max_focal, -1e6, 1e6));
  EXPECT_NO_THROW(Intrinsics(most, 2048, 1, 1, 0, 0));
  for (const auto& [width, height] :
       {std::pair(8192, 8193), {0, 1}, {1, -1}, {most + 1, 1}, {1, most + 1}})
    EXPECT_THROW(Intrinsics(width, height, 1, 1, 0, 0), InputError) << width << " x " << height;
  for (const double bad : {0.0, -1.0, nan, inf, 1.1 * Intrinsics::max_focal, 1e300}) {
    EXPECT_THROW(Intrinsics(1, 1, bad, 1, 0, 0), InputError) << bad;
    EXPECT_THROW(Intrinsics(1, 1, 1, bad, 0, 0), InputError) << bad;
  }
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_THROW(Intrinsics(1, 1, 1, 1, bad, 0), InputError) << bad;
    EXPECT_THROW(Intrinsics(1, 1, 1, 1, 0, bad), InputError) << bad;
  }
  expect_refused([] { Intrinsics(640, 480, -500, 510, 320, 240); }, {"fx = -500"});
}

TEST(Camera, ChecksItsRange) {
  Camera camera{Intrinsics(640, 480, 500, 500, 320, 240), {}, {}, {}};
  EXPECT_NO_THROW(camera.check());
  const std::pair<DepthRange, bool> ranges[] = {
      {{0.5, 3.0}, true},   {{0.0, inf}, true},  {{3.0, 0.5}, false}, {{1.0, 1.0}, false},
      {{-1.0, 1.0}, false}, {{nan, 1.0}, false}, {{0.0, nan}, false}, {{inf, inf}, false}};
  for (const auto& [range, is_good] : ranges) {
    camera.range = range;
    EXPECT_EQ(refusal([&] { camera.check(); }).empty(), is_good) << range.near << " " << range.far;
  }
}

}  // namespace
}  // namespace penumbra::test
