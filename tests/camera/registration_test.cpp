// SPDX-License-Identifier: Apache-2.0
// Depth images of closed-form scenes, brought from one camera to another, against the same scene
// cast from the other.
#include "../support/random.hpp"
#include "../support/sanitized.hpp"
#include "closed_form_scene.hpp"
#include "lens_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/camera/registration.hpp>

namespace penumbra {
namespace {

using test::Hit;
using test::Solid;

constexpr double float_rounding = 2e-5;       // metres: of points of a few metres in float32
constexpr double millimetre_rounding = 1e-3;  // of the source and of the result

Eigen::Isometry3d pose(double x, double y, double z, double angle = 0.0,
                       const Eigen::Vector3d& axis = Eigen::Vector3d::UnitY()) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  T.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return T;
}

Camera plain_camera(int width, int height, double focal) {
  return {.intrinsics = Intrinsics(width, height, focal, 1.02 * focal, 0.48 * width, 0.53 * height),
          .distortion = {},
          .range = {},
          .frame_id = {}};
}

/// A wall, tilted, behind everything, and solids before it.
struct Scene {
  std::vector<Solid> solids;

  [[nodiscard]] Scene seen_from(const Eigen::Isometry3d& T_other_this) const {
    Scene other = *this;
    for (Solid& solid : other.solids) solid.T_camera_solid = T_other_this * solid.T_camera_solid;
    return other;
  }

  [[nodiscard]] Hit hit(const Camera& camera, double u, double v) const {
    const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
    return ray ? test::nearest_hit(solids, *ray) : Hit{};
  }

  [[nodiscard]] Image<float> depth(const Camera& camera) const {
    Image<float> image(camera.intrinsics.width(), camera.intrinsics.height());
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u)
        image(u, v) = static_cast<float>(hit(camera, u, v).depth);
    return image;
  }
};

Solid box(const Eigen::Isometry3d& at, double x, double y, double z) {
  Solid solid;
  solid.T_camera_solid = at;
  solid.half_extents = Eigen::Vector3d(x, y, z);
  return solid;
}

Solid ball(double x, double y, double z, double radius) {
  Solid solid;
  solid.T_camera_solid = pose(x, y, z);
  solid.radius = radius;
  return solid;
}

Scene wall_and_solids() {
  Scene scene;
  scene.solids = {box(pose(0, 0, 2.5, 0.3), 30, 30, 0.1), ball(0.1, 0.05, 0.9, 0.15),
                  ball(-0.35, -0.1, 1.4, 0.2), box(pose(0.3, -0.2, 1.2, 0.7), 0.1, 0.12, 0.05),
                  box(pose(-0.1, 0.25, 0.7, -0.5, {1, 1, 0}), 0.06, 0.03, 0.04)};
  return scene;
}

/// What rays around a pixel, a quarter of a pixel apart, meet.
class Around {
 public:
  Around(const Scene& scene, const Camera& camera, double u, double v, double reach) {
    for (double y = -reach; y <= reach; y += 0.25)
      for (double x = -reach; x <= reach; x += 0.25)
        hits_.push_back(scene.hit(camera, u + x, v + y));
  }

  [[nodiscard]] bool all_of(std::size_t index) const {
    return std::all_of(hits_.begin(), hits_.end(), [&](const Hit& h) { return h.index == index; });
  }

  /// Whether the depth is one of those that some solid has here.
  [[nodiscard]] bool has(double depth, double tolerance) const {
    for (const Hit& solid : hits_) {
      if (solid.index == 0) continue;
      double low = 1e9, high = 0;
      for (const Hit& hit : hits_) {
        if (hit.index != solid.index) continue;
        low = std::min(low, hit.depth);
        high = std::max(high, hit.depth);
      }
      // Rays a quarter of a pixel apart do not meet the very ends.
      const double margin = tolerance + 0.15 * (high - low);
      if (depth > low - margin && depth < high + margin) return true;
    }
    return false;
  }

 private:
  std::vector<Hit> hits_;
};

struct Pair {
  std::string name;
  Camera from, to;
  Eigen::Isometry3d T_to_from;
};

struct Score {
  std::size_t checked = 0;  ///< pixels that must be measured
  std::size_t holes = 0;    ///< of those
  std::size_t measured = 0;
  std::size_t wrong = 0;  ///< measured at a depth that nothing has there
};

/// Judges every pixel. One must be measured if all around it is one surface, and so it is around
/// where the first camera sees that very point.
Score judge(const Pair& pair, const Scene& in_from, const DepthView& warped, double tolerance) {
  const Scene in_to = in_from.seen_from(pair.T_to_from);
  const Eigen::Isometry3d T_from_to = pair.T_to_from.inverse();
  Score score;
  for (int v = 0; v < pair.to.intrinsics.height(); v += test::sample_stride) {
    for (int u = 0; u < pair.to.intrinsics.width(); ++u) {
      const double measured = std::visit(
          [&](const auto& view) {
            const double value = view(u, v);
            return std::is_same_v<const std::remove_reference_t<decltype(view(u, v))>, const float>
                       ? value
                       : 1e-3 * value;
          },
          warped);
      // A footprint in this image is as wide as a source pixel looks from here.
      const Around here(in_to, pair.to, u, v, 2.0);
      if (measured > 0) {
        ++score.measured;
        if (!here.has(measured, tolerance)) ++score.wrong;
      }
      const Hit hit = in_to.hit(pair.to, u, v);
      if (hit.index == 0 || !here.all_of(hit.index)) continue;
      const auto ray = pair.to.distortion.undistort(pair.to.intrinsics.ray(u, v).head<2>());
      const Eigen::Vector3d point =
          T_from_to * Eigen::Vector3d(ray->x() * hit.depth, ray->y() * hit.depth, hit.depth);
      if (point.z() <= 0.05) continue;
      const Eigen::Vector2d seen = pair.from.distortion.distort(point.head<2>() / point.z());
      const Eigen::Vector2d pixel = pair.from.intrinsics.project({seen.x(), seen.y(), 1});
      const bool inside = pixel.x() >= 2 && pixel.y() >= 2 &&
                          pixel.x() <= pair.from.intrinsics.width() - 3 &&
                          pixel.y() <= pair.from.intrinsics.height() - 3;
      if (!inside || (point.head<2>() / point.z()).norm() > pair.from.distortion.max_radius())
        continue;
      if (!Around(in_from, pair.from, pixel.x(), pixel.y(), 2.0).all_of(hit.index)) continue;
      if (std::abs(in_from.hit(pair.from, pixel.x(), pixel.y()).depth - point.z()) > 1e-6) continue;
      ++score.checked;
      if (measured == 0) ++score.holes;
    }
  }
  return score;
}

Camera with_lens(Camera camera, const test::Lens& lens) {
  camera.distortion = lens.distortion();
  return camera;
}

std::vector<Pair> pairs() {
  const Camera small = plain_camera(160, 120, 130);
  const Camera large = plain_camera(300, 220, 250);
  const auto lenses = test::typical_lenses();
  return {{"beside each other", small, small, pose(-0.05, 0.01, 0.0, 0.02)},
          {"apart and turned", small, small, pose(-0.5, 0.05, 0.2, 0.3)},
          {"to more pixels", small, large, pose(0.06, 0.0, 0.01)},
          {"to fewer pixels", large, small, pose(0.06, 0.0, 0.01)},
          {"rolled", small, large, pose(0.03, -0.02, 0.0, 0.8, {0.1, 0, 1})},
          {"upside down", small, small, pose(0.03, -0.02, 0.0, 3.1, {0, 0, 1})},
          {"from a distorting lens", with_lens(small, lenses[0]), small, pose(0.05, 0, 0, 0.02)},
          {"to a distorting lens", small, with_lens(small, lenses[7]), pose(0.05, 0, 0, 0.02)},
          {"between two", with_lens(small, lenses[6]), with_lens(large, lenses[2]),
           pose(0.03, 0.004, 0.002, 0.1, {1, 0, 0})}};
}

TEST(Registration, SeesTheSceneAsTheOtherCameraDoes) {
  const Scene scene = wall_and_solids();
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    DepthRegistration registration(pair.from, pair.to);
    const Image<float> metres = scene.depth(pair.from);
    const Score score =
        judge(pair, scene, registration.warp(metres.view(), pair.T_to_from), float_rounding);
    EXPECT_EQ(score.holes, 0U) << "of " << score.checked;
    EXPECT_EQ(score.wrong, 0U) << "of " << score.measured;
    EXPECT_GT(score.checked, static_cast<std::size_t>(test::samples(4000)));

    Image<std::uint16_t> millimetres(metres.width(), metres.height());
    std::transform(metres.data(), metres.data() + metres.size(), millimetres.data(),
                   [](float z) { return static_cast<std::uint16_t>(std::lround(1e3F * z)); });
    const Score coarse =
        judge(pair, scene, registration.warp(std::as_const(millimetres).view(), pair.T_to_from),
              millimetre_rounding);
    EXPECT_EQ(coarse.holes, 0U) << "of " << coarse.checked;
    EXPECT_EQ(coarse.wrong, 0U) << "of " << coarse.measured;
  }
}

TEST(Registration, IsTheSameImageInTheSameCamera) {
  const Camera camera = plain_camera(160, 120, 130);
  const Image<float> depth = wall_and_solids().depth(camera);
  DepthRegistration registration(camera, camera);
  const auto warped = std::get<ImageView<const float>>(
      registration.warp(depth.view(), Eigen::Isometry3d::Identity()));
  std::size_t changed = 0;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) changed += warped(u, v) != depth(u, v) ? 1 : 0;
  EXPECT_EQ(changed, 0U);
}

TEST(Registration, WhatIsNotMeasuredStaysSo) {
  const Camera camera = plain_camera(80, 60, 70);
  DepthRegistration registration(camera, camera);
  Image<float> depth(80, 60, 1.0F);
  const float none[] = {0.0F,   -1.0F, std::nanf(""), std::numeric_limits<float>::infinity(),
                        0.005F, 2e6F};
  for (int i = 0; i < 6; ++i) depth(10 + 5 * i, 30) = none[i];
  const auto same = std::get<ImageView<const float>>(
      registration.warp(depth.view(), Eigen::Isometry3d::Identity()));
  for (int v = 0; v < 60; ++v)
    for (int u = 0; u < 80; ++u) {
      const bool hole = v == 30 && u >= 10 && u <= 35 && u % 5 == 0;
      EXPECT_EQ(same(u, v), hole ? 0.0F : 1.0F) << u << ',' << v;
    }
}

TEST(Registration, OnlyDepthsOfTheSensorsRangeCount) {
  Camera camera = plain_camera(80, 60, 70);
  camera.range = {0.5, 2.0};
  DepthRegistration registration(camera, camera);
  for (const auto& [depth, kept] :
       {std::pair{0.49F, 0.0F}, {0.51F, 0.51F}, {1.99F, 1.99F}, {2.01F, 0.0F}}) {
    const Image<float> image(80, 60, depth);
    const auto same = std::get<ImageView<const float>>(
        registration.warp(image.view(), Eigen::Isometry3d::Identity()));
    EXPECT_EQ(same(40, 30), kept);
  }
}

TEST(Registration, MillimetresThatDoNotFitAreNone) {
  const Camera camera = plain_camera(80, 60, 70);
  DepthRegistration registration(camera, camera);
  const Image<std::uint16_t> image(80, 60, 65'000);
  const auto at = [&](double z) {
    return std::get<ImageView<const std::uint16_t>>(registration.warp(image.view(), pose(0, 0, z)))(
        40, 30);
  };
  EXPECT_EQ(at(0.5), 65'500);
  EXPECT_EQ(at(0.6), 0);
  EXPECT_EQ(at(-64.992), 0) << "nearer than min_depth";
  EXPECT_EQ(at(-66.0), 0) << "behind the camera";
}

TEST(Registration, TheNearerSurfaceHidesTheFarther) {
  const Camera camera = plain_camera(160, 120, 130);
  Image<float> depth(160, 120, 2.0F);
  for (int v = 40; v < 80; ++v)
    for (int u = 60; u < 100; ++u) depth(u, v) = 1.0F;
  DepthRegistration registration(camera, camera);
  // The near square moves by 13 pixels, the wall by 6.5: beside the square there are holes.
  const auto seen =
      std::get<ImageView<const float>>(registration.warp(depth.view(), pose(0.1, 0, 0)));
  EXPECT_EQ(seen(72, 60), 0.0F) << "uncovered by the square, seen by neither";
  EXPECT_EQ(seen(74, 60), 1.0F);
  EXPECT_EQ(seen(112, 60), 1.0F) << "the wall behind it is there too";
  EXPECT_EQ(seen(114, 60), 2.0F);
  EXPECT_EQ(seen(64, 60), 2.0F);
  for (int u = 0; u < 160; ++u)
    EXPECT_TRUE(seen(u, 60) == 0.0F || seen(u, 60) == 1.0F || seen(u, 60) == 2.0F)
        << "depths are not mixed";
}

TEST(Registration, StridesAreFollowedAndRubbishIsSafe) {
  auto random = test::seeded_random(9);
  const Camera from = plain_camera(64, 48, 50);
  const Camera to = plain_camera(90, 40, 60);
  DepthRegistration registration(from, to);
  const Image<float> padded(80, 48, 1.5F);
  const ImageView<const float> view{padded.data(), 64, 48, 80};
  const auto seen =
      std::get<ImageView<const float>>(registration.warp(view, Eigen::Isometry3d::Identity()));
  EXPECT_EQ(seen(45, 20), 1.5F);
  Image<float> rubbish(64, 48);
  for (int round = 0; round < test::samples(20); ++round) {
    for (std::size_t i = 0; i < rubbish.size(); ++i)
      rubbish.data()[i] = static_cast<float>(
          std::pow(10.0, std::uniform_real_distribution<double>(-3, 40)(random)));
    static_cast<void>(registration.warp(
        rubbish.view(), pose(0.3, -0.2, -0.5, 0.4 * round, Eigen::Vector3d(1, round, 2))));
  }
}

TEST(Registration, AFootprintIsBounded) {
  const Camera from = plain_camera(64, 48, 50);
  const Camera to = plain_camera(400, 400, 5000);
  DepthRegistration registration(from, to);
  Image<float> depth(64, 48);
  depth(31, 25) = 1.0F;
  const auto seen =
      std::get<ImageView<const float>>(registration.warp(depth.view(), pose(0, 0, -0.9)));
  std::size_t covered = 0;
  for (int v = 0; v < 400; ++v)
    for (int u = 0; u < 400; ++u) covered += seen(u, v) > 0 ? 1 : 0;
  EXPECT_LE(covered, static_cast<std::size_t>(4 * DepthRegistration::max_reach *
                                              DepthRegistration::max_reach));
}

TEST(Registration, RefusesWhatIsNoImageOfTheCamera) {
  const Camera camera = plain_camera(80, 60, 70);
  DepthRegistration registration(camera, camera);
  const Image<float> image(81, 60);
  EXPECT_THROW(static_cast<void>(registration.warp(image.view(), Eigen::Isometry3d::Identity())),
               std::invalid_argument);
  Camera reversed = camera;
  reversed.range = {3, 1};
  EXPECT_THROW(DepthRegistration(reversed, camera), InputError);
}

}  // namespace
}  // namespace penumbra
