// SPDX-License-Identifier: Apache-2.0
#include "../support/test.hpp"

#include <penumbra/camera/camera.hpp>

namespace penumbra::test {
namespace {

constexpr double rounding = 1e-9;  // pixels; thousands of units in the last place of what is tested

TEST(Intrinsics, PixelCentresAreAtIntegers) {
  const Intrinsics camera(640, 480, 500, 510, 320, 240);
  EXPECT_EQ(camera.ray(320, 240), Vector3d(0, 0, 1));
  EXPECT_EQ(camera.ray(820, -270), Vector3d(1, -1, 1));
  EXPECT_EQ(camera.project({0.5, 1.0, 2.0}), Vector2d(445, 495));
}

TEST(Intrinsics, ProjectUndoesRay) {
  auto random = seeded_random(1);
  std::uniform_real_distribution<double> pixel(-5000, 5000);
  std::uniform_real_distribution<double> focal_length(1, 3000);
  std::uniform_real_distribution<double> depth(0.01, 10);
  for (int i = 0; i < 1000; ++i) {
    const Intrinsics camera(10, 10, focal_length(random), focal_length(random), pixel(random),
                            pixel(random));
    const Vector2d p(pixel(random), pixel(random));
    EXPECT_LT((camera.project(depth(random) * camera.ray(p.x(), p.y())) - p).norm(), rounding);
  }
}

TEST(Intrinsics, RefusesWhatIsNoCamera) {
  EXPECT_NO_THROW(Intrinsics(1, 1, 1e-3, 1e-3, -1e6, 1e6));
  EXPECT_NO_THROW(Intrinsics(Intrinsics::max_size, 2048, 1, 1, 0, 0));
  EXPECT_NO_THROW(Intrinsics(8192, 8192, 1, 1, 0, 0));
  EXPECT_THROW(Intrinsics(8192, 8193, 1, 1, 0, 0), InputError);
  EXPECT_THROW(Intrinsics(0, 1, 1, 1, 0, 0), InputError);
  EXPECT_THROW(Intrinsics(1, -1, 1, 1, 0, 0), InputError);
  EXPECT_THROW(Intrinsics(Intrinsics::max_size + 1, 1, 1, 1, 0, 0), InputError);
  EXPECT_THROW(Intrinsics(1, Intrinsics::max_size + 1, 1, 1, 0, 0), InputError);
  EXPECT_NO_THROW(Intrinsics(1, 1, Intrinsics::max_focal, Intrinsics::max_focal, 0, 0));
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

// A block of pixels covers the square of rays that its pixels cover, and its centre is the
// square's.
TEST(Intrinsics, BinnedPixelIsTheMiddleOfItsBlock) {
  const Intrinsics full(641, 482, 500, 510, 300.25, -20.5);
  const Intrinsics binned = full.binned(3, 2);
  EXPECT_EQ(binned.width(), 213);
  EXPECT_EQ(binned.height(), 241);
  for (const int u : {0, 1, 200})
    for (const int v : {0, 7, 240}) {
      const Vector3d middle = 0.5 * (full.ray(3 * u, 2 * v) + full.ray(3 * u + 2, 2 * v + 1));
      EXPECT_LT((binned.ray(u, v) - middle).norm(), rounding);
    }
  EXPECT_EQ(full.binned(1, 1), full);
}

TEST(Intrinsics, CroppedKeepsRays) {
  const Intrinsics full(640, 480, 500, 510, 300.25, 200);
  const Intrinsics window = full.cropped(100, 50, 540, 430);
  EXPECT_EQ(window.width(), 540);
  EXPECT_EQ(window.height(), 430);
  EXPECT_LT((window.ray(7, 9) - full.ray(107, 59)).norm(), rounding);
  EXPECT_EQ(full.cropped(0, 0, 640, 480), full);
}

TEST(Intrinsics, RefusesWindowsAndBlocksThatDoNotFit) {
  const Intrinsics full(640, 480, 500, 510, 300, 200);
  constexpr int most = std::numeric_limits<int>::max();
  EXPECT_THROW((void)full.binned(0, 1), InputError);
  EXPECT_THROW((void)full.binned(1, 481), InputError);
  EXPECT_THROW((void)full.binned(most, 1), InputError);
  EXPECT_THROW((void)full.cropped(-1, 0, 10, 10), InputError);
  EXPECT_THROW((void)full.cropped(0, 0, 641, 10), InputError);
  EXPECT_THROW((void)full.cropped(600, 0, 41, 10), InputError);
  EXPECT_THROW((void)full.cropped(0, 471, 10, 10), InputError);
  EXPECT_THROW((void)full.cropped(most, most, 10, 10), InputError);
  EXPECT_THROW((void)full.cropped(0, 0, most, most), InputError);
  EXPECT_THROW((void)full.cropped(0, 0, 0, 10), InputError);
}

TEST(Camera, ChecksItsRange) {
  Camera camera{Intrinsics(640, 480, 500, 500, 320, 240), {}, {}, {}};
  EXPECT_NO_THROW(camera.check());
  for (const DepthRange good : {DepthRange{0.5, 3}, DepthRange{0, inf}}) {
    camera.range = good;
    EXPECT_NO_THROW(camera.check());
  }
  for (const DepthRange bad : {DepthRange{3, 0.5}, DepthRange{1, 1}, DepthRange{-1, 1},
                               DepthRange{nan, 1}, DepthRange{0, nan}, DepthRange{inf, inf}}) {
    camera.range = bad;
    EXPECT_THROW(camera.check(), InputError) << bad.near << " .. " << bad.far;
  }
}

}  // namespace
}  // namespace penumbra::test
