// SPDX-License-Identifier: Apache-2.0
#include "lens_samples.hpp"

#include <Eigen/LU>

namespace penumbra::test {
namespace {

constexpr double focal = 1000;  // pixels: turns points of the plane z = 1 into pixels
constexpr double round_trip_px = 1e-9;
// As close to the edge as 1e-9 pixels can be asked for: the derivative there is still some 1e-3,
// and the inverse magnifies rounding by its reciprocal.
constexpr double near_the_edge = 0.999;

void expect_round_trip(const Lens& sample, const Distortion& lens, const Vector2d& p) {
  const Vector2d distorted = lens.distort(p);
  const auto back = lens.undistort(distorted);
  ASSERT_TRUE(back) << sample.name << ' ' << p.transpose();
  EXPECT_LT(focal * (lens.distort(*back) - distorted).norm(), round_trip_px)
      << sample.name << ' ' << p.transpose();
  // Seen as pixels of the raw image: what the inverse is off times the least magnification.
  EXPECT_LT(focal * (lens.derivative(p) * (*back - p)).norm(), round_trip_px)
      << sample.name << ' ' << p.transpose();
}

TEST(Distortion, KnowsRosNames) {
  const std::vector<double> five(5, 0.1), eight(8, 0.1), four(4, 0.1);
  EXPECT_EQ(Distortion("plumb_bob", five).model(), DistortionModel::plumb_bob);
  EXPECT_EQ(Distortion("plumb_bob", four).model(), DistortionModel::plumb_bob);
  EXPECT_EQ(Distortion("rational_polynomial", eight).model(), DistortionModel::rational_polynomial);
  for (const char* name : {"equidistant", "fisheye", "kannala_brandt4"})
    EXPECT_EQ(Distortion(name, four).model(), DistortionModel::equidistant) << name;
  EXPECT_TRUE(Distortion("", {}).is_none());
  EXPECT_TRUE(Distortion().is_none());
  EXPECT_TRUE(Distortion("none", std::vector<double>(5, 0.0)).is_none());
  EXPECT_TRUE(Distortion("plumb_bob", std::vector<double>(5, 0.0)).is_none());
  EXPECT_TRUE(Distortion("rational_polynomial", std::vector<double>(14, 0.0)).is_none());
  // All 0 is the ideal fisheye, not no distortion.
  EXPECT_EQ(Distortion("equidistant", std::vector<double>(4, 0.0)).model(),
            DistortionModel::equidistant);
  EXPECT_EQ(to_string(DistortionModel::rational_polynomial), "rational_polynomial");
}

TEST(Distortion, IdealFisheyeHasAClosedFormInverse) {
  const Distortion lens("equidistant", std::vector<double>(4, 0.0));
  for (const double degrees : {0.0, 1e-6, 1.0, 45.0, 80.0, 89.9}) {
    const double theta = degrees * std::numbers::pi / 180;
    const auto p = lens.undistort({theta, 0});
    ASSERT_TRUE(p) << degrees;
    EXPECT_DOUBLE_EQ(p->x(), std::tan(theta));
    EXPECT_EQ(p->y(), 0);
  }
  EXPECT_FALSE(lens.undistort({std::numbers::pi / 2 + 1e-12, 0}));
  EXPECT_FALSE(lens.undistort({0, -2}));
}

TEST(Distortion, MaxRadiusIsWhereTheModelStopsGrowing) {
  const auto radius = [](const std::string& model, const std::vector<double>& k) {
    return Distortion(model, k).max_radius();
  };
  constexpr double precise = 1e-8;  // the radius or angle stays 1e-9 of itself off the root
  constexpr double largest = 100;
  EXPECT_EQ(radius("plumb_bob", {0.3, 0.1, 0, 0, 0}), largest);
  EXPECT_NEAR(radius("plumb_bob", {-0.3, 0, 0, 0, 0}), std::sqrt(1 / 0.9), precise);
  // a pole at r^2 = 2 before which the model grows
  EXPECT_NEAR(radius("rational_polynomial", {0, 0, 0, 0, 0, -0.5, 0, 0}), std::sqrt(2), precise);
  // r / (1 + r^2): grows up to 1
  EXPECT_NEAR(radius("rational_polynomial", {0, 0, 0, 0, 0, 1, 0, 0}), 1, precise);
  EXPECT_EQ(radius("rational_polynomial", {1, 0, 0, 0, 0, 1, 0, 0}), largest);
  // equidistant counts angles: 1 - 3 theta^2 / 3
  EXPECT_NEAR(radius("equidistant", {-1.0 / 3, 0, 0, 0}), std::tan(1.0), precise);
  EXPECT_EQ(radius("equidistant", {-0.1, 0, 0, 0}),
            inf);  // the fold lies at 105 degrees
}

TEST(Distortion, AbsurdCoefficientsMapNothingOrSomethingButDoNotHang) {
  auto random = seeded_random(2);
  std::uniform_real_distribution<double> exponent(-320, 308);
  for (int i = 0; i < 500; ++i) {
    std::vector<double> k(8);
    for (double& c : k) c = (random() % 2 != 0 ? 1 : -1) * std::pow(10, exponent(random));
    const Distortion lens("rational_polynomial", k);
    EXPECT_GE(lens.max_radius(), 0);
    for (const double reach : {1e-300, 1e-3, 1.0, 1e300})
      if (const auto p = lens.undistort({reach, reach})) {
        EXPECT_LE(p->norm(), lens.max_radius() * (1 + 1e-12));
      }
  }
  EXPECT_FALSE(Distortion("plumb_bob", std::vector<double>{0.1, 0, 0, 0, 0}).undistort({nan, 0}));
}

TEST(Distortion, UndistortUndoesDistort) {
  auto random = seeded_random(3);
  std::vector<Lens> lenses = typical_lenses();
  for (int i = 0; i < 500; ++i) lenses.push_back(random_lens(random));
  for (const Lens& sample : lenses) {
    const Distortion lens = sample.distortion();
    EXPECT_EQ(lens.undistort({0, 0}).value(), Vector2d(0, 0));
    for (int i = 0; i < 100; ++i)
      expect_round_trip(sample, lens, random_point_inside(lens, near_the_edge, random));
  }
}

// Inside the radius no fold: the derivative keeps a positive determinant. And what lies outside of
// the image of the disc is refused, also with tangential terms: such points have no inverse within
// the radius, as a dense search finds.
TEST(Distortion, DerivativeAgreesWithDifferences) {
  constexpr double h = 1e-5;
  constexpr double close = 1e-6;  // third derivatives of up to some 1e3, times h^2
  auto random = seeded_random(6);
  for (int i = 0; i < 1000; ++i) {
    const Lens sample = random_lens(random);
    const Distortion lens = sample.distortion();
    const Vector2d p = random_point_inside(lens, 0.9, random);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d step = h * Vector2d::Unit(axis);
      const Vector2d difference = (lens.distort(p + step) - lens.distort(p - step)) / (2 * h);
      EXPECT_LT((lens.derivative(p).col(axis) - difference).norm(), close)
          << sample.model << ' ' << p.transpose();
    }
  }
  for (const Lens& sample : typical_lenses())
    EXPECT_EQ(sample.distortion().derivative({0, 0}), Eigen::Matrix2d::Identity());
}

TEST(Distortion, IsOneToOneInsideAndSilentOutside) {
  auto random = seeded_random(5);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  for (int i = 0; i < 300; ++i) {
    const Lens sample = random_lens(random);
    const Distortion lens = sample.distortion();
    for (int j = 0; j < 50; ++j) {
      const Vector2d p = random_point_inside(lens, near_the_edge, random);
      EXPECT_GT(lens.derivative(p).determinant(), 0) << sample.model;
    }
    if (!(lens.max_radius() < 1e3)) continue;
    const double a = angle(random);
    const Vector2d rim = lens.max_radius() * Vector2d(std::cos(a), std::sin(a));
    const Vector2d edge = lens.distort(rim);
    if (!(edge.norm() < 1e3)) continue;  // a pole: the image has no edge
    EXPECT_FALSE(lens.undistort(edge * 1.000001)) << sample.model << ' ' << edge.transpose();
    EXPECT_TRUE(lens.undistort(edge * 0.999999)) << sample.model << ' ' << edge.transpose();
  }
}

TEST(Intrinsics, PixelCentresAreAtIntegers) {
  const Intrinsics camera(640, 480, 500, 510, 320, 240);
  EXPECT_EQ(camera.ray(320, 240), Vector3d(0, 0, 1));
  EXPECT_EQ(camera.ray(820, -270), Vector3d(1, -1, 1));
  EXPECT_EQ(camera.project({0.5, 1.0, 2.0}), Vector2d(445, 495));
}

TEST(Intrinsics, RefusesWhatIsNoCamera) {
  constexpr int most = Intrinsics::max_size;
  EXPECT_NO_THROW(Intrinsics(1, 1, 1e-2, Intrinsics::max_focal, -1e6, 1e6));
  EXPECT_NO_THROW(Intrinsics(most, 2048, most, most, 0, 0));
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
  expect_refused([] { Intrinsics(848, 480, 1.93, 1.93, 424, 240); }, {"fx = 1.93", "pixels"});
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
