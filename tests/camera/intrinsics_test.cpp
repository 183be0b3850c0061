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
  for (const auto& [across, down] : {std::pair(0, 1), {1, 481}, {most, 1}})
    EXPECT_THROW((void)full.binned(across, down), InputError) << across << ' ' << down;
  for (const auto& [u, v, width, height] :
       std::initializer_list<std::array<int, 4>>{{-1, 0, 10, 10},
                                                 {0, 0, 641, 10},
                                                 {600, 0, 41, 10},
                                                 {0, 471, 10, 10},
                                                 {most, most, 10, 10},
                                                 {0, 0, most, most},
                                                 {0, 0, 0, 10}})
    EXPECT_THROW((void)full.cropped(u, v, width, height), InputError) << u << ' ' << v;
}

TEST(Camera, ChecksItsRange) {
  Camera camera{Intrinsics(640, 480, 500, 500, 320, 240), {}, {}, {}};
  EXPECT_NO_THROW(camera.check());
  for (const auto& [near, far, is_good] :
       std::initializer_list<std::tuple<double, double, bool>>{{0.5, 3, true},
                                                               {0, inf, true},
                                                               {3, 0.5, false},
                                                               {1, 1, false},
                                                               {-1, 1, false},
                                                               {nan, 1, false},
                                                               {0, nan, false},
                                                               {inf, inf, false}}) {
    camera.range = {near, far};
    EXPECT_EQ(refusal([&] { camera.check(); }).empty(), is_good) << near << " .. " << far;
  }
}

}  // namespace
}  // namespace penumbra::test
