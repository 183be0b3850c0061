// SPDX-License-Identifier: Apache-2.0
#include "lens_samples.hpp"

#include <penumbra/camera/rectification.hpp>

namespace penumbra::test {
namespace {

// Half a pixel's diagonal is 0.707; the rest is for the lens's bending within a pixel.
constexpr double worst_px = 0.75, most_half_angle = 1.3;

Camera camera_with(const Intrinsics& intrinsics, const Distortion& lens) {
  return {intrinsics, lens, {}, {}};
}

Camera random_camera(const Distortion& lens, std::mt19937_64& random) {
  std::uniform_int_distribution<int> size(30, 130);
  std::uniform_real_distribution<double> unit(0, 1);
  const int width = size(random), height = size(random);
  const double fx = width * (0.4 + 1.2 * unit(random));
  const Intrinsics k(width, height, fx, fx * (0.9 + 0.2 * unit(random)),
                     width * (1.4 * unit(random) - 0.2), height * (1.4 * unit(random) - 0.2));
  return camera_with(k, lens);
}

Vector2d ray_of(const Intrinsics& pinhole, std::int32_t index) {
  const int row = index / pinhole.width();
  return pinhole.ray(index % pinhole.width(), row).head<2>();
}

/// Raw image point of an undistorted point, in pixels.
Vector2d raw_point(const Camera& camera, const Vector2d& ray) {
  const Vector2d p = camera.distortion.distort(ray);
  return camera.intrinsics.project({p.x(), p.y(), 1});
}

void check_raw_to_pinhole(const Camera& camera, const Rectification& maps) {
  const Intrinsics& k = camera.intrinsics;
  int mapped = 0;
  for (const auto [u, v] : each_pixel(k)) {
    const auto ray = camera.distortion.undistort(k.ray(u, v).head<2>());
    const bool reached = ray && std::atan(ray->norm()) <= maps.half_angle();
    const std::int32_t index = maps.raw_to_pinhole()(u, v);
    ASSERT_EQ(reached, index != Rectification::no_pixel) << u << ' ' << v;
    if (!reached) continue;
    ++mapped;
    const Vector2d seen = raw_point(camera, ray_of(maps.pinhole(), index));
    ASSERT_LT((seen - Vector2d(u, v)).norm(), worst_px) << u << ' ' << v;
  }
  ASSERT_GT(mapped, 0);
}

void check_pinhole_to_raw(const Camera& camera, const Rectification& maps) {
  const Intrinsics& p = maps.pinhole();
  const double reach = std::min(std::tan(maps.half_angle()), camera.distortion.max_radius());
  const ImageView<const std::int32_t> map = maps.pinhole_to_raw();
  ASSERT_EQ(map.width, p.width());
  ASSERT_EQ(map.height, p.height());
  for (const auto [u, v] : each_pixel(p)) {
    const Vector2d ray = p.ray(u, v).head<2>();
    const Vector2d point = raw_point(camera, ray).array().round();
    const bool seen = ray.norm() <= reach && point.minCoeff() >= 0 &&
                      point.x() < camera.intrinsics.width() &&
                      point.y() < camera.intrinsics.height();
    const std::int32_t index = map(u, v);
    ASSERT_EQ(seen, index != Rectification::no_pixel) << u << ' ' << v;
    if (!seen) continue;
    ASSERT_EQ(index % camera.intrinsics.width(), point.x());
    ASSERT_EQ(index / camera.intrinsics.width(), point.y());
  }
}

std::size_t pixels(const Intrinsics& k) { return std::size_t(k.width()) * std::size_t(k.height()); }

TEST(Rectification, MapsOfTypicalLenses) {
  for (const Lens& sample : typical_lenses()) {
    SCOPED_TRACE(sample.name);
    const Intrinsics k(200, 150, 100, 101, 101.3, 73.2);
    const Camera camera = camera_with(k, sample.distortion());
    const Rectification maps(camera, most_half_angle);
    EXPECT_EQ(maps.half_angle(), most_half_angle);  // not cut: sane lenses, a small image
    check_raw_to_pinhole(camera, maps);
    check_pinhole_to_raw(camera, maps);
  }
}

TEST(Rectification, MapsOfRandomCamerasAndLenses) {
  auto random = seeded_random(21);
  int made = 0;
  int cut = 0;  // lenses that stretch too much, mostly before a pole
  for (int i = 0; i < 60; ++i) {
    const Lens sample = random_lens(random);
    const Camera camera = random_camera(sample.distortion(), random);
    std::optional<Rectification> maps;
    try {
      maps.emplace(camera, most_half_angle);
    } catch (const InputError&) {
      continue;  // the principal point may lie farther outside than the lens reaches
    }
    SCOPED_TRACE(testing::Message() << "camera " << i << ' ' << sample.model);
    check_raw_to_pinhole(camera, *maps);
    check_pinhole_to_raw(camera, *maps);
    if (HasFatalFailure()) return;
    EXPECT_LE(maps->pinhole().fx(), camera.intrinsics.fx() * Rectification::max_stretch);
    ++made;
    cut += maps->half_angle() < most_half_angle;
  }
  std::cout << cut << " of " << made << " cut\n";
  EXPECT_GT(made, 50);
  EXPECT_LT(cut, 20);
}

TEST(Rectification, LargeFisheyesAreCutToAnImageThatFits) {
  const std::vector<double> ideal(4, 0.0);
  const Camera camera =
      camera_with(Intrinsics(1600, 400, 480, 480, 799.5, 199.5), Distortion("equidistant", ideal));
  const double asked = 1.5;  // 86 degrees: tan is 14, so 13 500 x 3600 pixels
  const Rectification maps(camera, asked);
  EXPECT_LT(maps.half_angle(), asked);
  EXPECT_LE(pixels(maps.pinhole()),
            std::max(Rectification::max_pixels, 4 * pixels(camera.intrinsics)));
  EXPECT_GE(maps.pinhole().fx(), 479.99);  // the resolution is not what is given up
  const Intrinsics& k = camera.intrinsics;
  for (int u = 0; u < k.width(); ++u) {
    const double theta = k.ray(u, 199).head<2>().norm();
    const bool mapped = maps.raw_to_pinhole()(u, 199) != Rectification::no_pixel;
    EXPECT_EQ(mapped, theta < maps.half_angle()) << u;
  }
}

// r / (1 - r^2 / 2) stretches by 4 at r = 0.902, 0.734 radians off the axis, which is put 152
// pixels from the centre of this image.
TEST(Rectification, StretchesOfNoRealLensAreCut) {
  const std::vector<double> pole{0, 0, 0, 0, 0, -0.5, 0, 0};
  const Camera camera =
      camera_with(Intrinsics(401, 11, 100, 100, 200, 5), Distortion("rational_polynomial", pole));
  const Rectification maps(camera);
  EXPECT_NEAR(maps.half_angle(), 0.734, 0.01);
  EXPECT_GT(maps.pinhole().fx(), 350);
  EXPECT_LE(maps.pinhole().fx(), 400);
  check_raw_to_pinhole(camera, maps);
  EXPECT_EQ(maps.raw_to_pinhole()(46, 5), Rectification::no_pixel);
  EXPECT_NE(maps.raw_to_pinhole()(56, 5), Rectification::no_pixel);
}

TEST(Rectification, RefusesALensThatReachesNoPixel) {
  const Camera camera =
      camera_with(Intrinsics(640, 480, 500, 500, -900, 240), typical_lenses().front().distortion());
  EXPECT_THROW(Rectification maps(camera), InputError);
}

}  // namespace
}  // namespace penumbra::test
