// SPDX-License-Identifier: Apache-2.0
// Depth images of closed-form scenes, transformed to another camera, against ray casts from there.
#include "lens_samples.hpp"

#include <penumbra/camera/camera.hpp>
#include <penumbra/camera/registration.hpp>

namespace penumbra::test {
namespace {

constexpr double float_rounding = 2e-5;       // metres: of points of a few metres in float32
constexpr double millimetre_rounding = 1e-3;  // of the source and of the result

Isometry3d pose(double x, double y, double z, double angle = 0.0,
                const Vector3d& axis = Vector3d::UnitY()) {
  Isometry3d T = at(x, y, z);
  T.linear() = AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return T;
}

Camera plain_camera(int width, int height, double f) {
  return {Intrinsics(width, height, f, 1.02 * f, 0.48 * width, 0.53 * height), {}, {}, {}};
}

/// A box or a sphere in the optical frame, metres.
struct Solid {
  Isometry3d T_camera_solid = Isometry3d::Identity();
  Vector3d half_extents = Vector3d::Zero();  ///< of a box
  double radius = 0;                         ///< of a sphere, if not 0

  /// Depth at which the ray (x, y, 1) from the origin enters; 0 where it misses.
  [[nodiscard]] double depth(const Vector2d& ray) const {
    const Vector3d along(ray.x(), ray.y(), 1);
    if (radius == 0) {
      const Isometry3d to_box = T_camera_solid.inverse();
      return enter_box(to_box.translation(), to_box.linear() * along, half_extents).value_or(0);
    }
    const Vector3d centre = T_camera_solid.translation();
    const double a = along.squaredNorm(), b = along.dot(centre);
    const double root = b * b - a * (centre.squaredNorm() - radius * radius);
    return root < 0 ? 0 : std::max((b - std::sqrt(root)) / a, 0.0);
  }
};

struct Hit {
  double depth = 0;       ///< metres; 0: nothing
  std::size_t index = 0;  ///< of the solid + 1; 0: nothing
};

/// A wall, tilted, behind everything, and solids before it.
struct Scene {
  std::vector<Solid> solids;

  [[nodiscard]] Scene seen_from(const Isometry3d& T_other_this) const {
    Scene other = *this;
    for (Solid& solid : other.solids) solid.T_camera_solid = T_other_this * solid.T_camera_solid;
    return other;
  }

  [[nodiscard]] Hit hit(const Camera& camera, double u, double v) const {
    const auto ray = camera.distortion.undistort(camera.intrinsics.ray(u, v).head<2>());
    Hit nearest;
    for (std::size_t i = 0; ray && i < solids.size(); ++i) {
      const double depth = solids[i].depth(*ray);
      if (depth > 0 && (nearest.index == 0 || depth < nearest.depth)) nearest = {depth, i + 1};
    }
    return nearest;
  }

  [[nodiscard]] Image<float> depth(const Camera& camera) const {
    Image<float> image(camera.intrinsics.width(), camera.intrinsics.height());
    for (const auto [u, v] : each_pixel(image)) image(u, v) = float(hit(camera, u, v).depth);
    return image;
  }
};

Solid box(const Isometry3d& at, double x, double y, double z) {
  return {.T_camera_solid = at, .half_extents = {x, y, z}};
}

Solid ball(double x, double y, double z, double radius) {
  return {.T_camera_solid = at(x, y, z), .radius = radius};
}

Scene wall_and_solids() {
  return {{box(pose(0, 0, 2.5, 0.3), 30, 30, 0.1), ball(0.1, 0.05, 0.9, 0.15),
           ball(-0.35, -0.1, 1.4, 0.2), box(pose(0.3, -0.2, 1.2, 0.7), 0.1, 0.12, 0.05),
           box(pose(-0.1, 0.25, 0.7, -0.5, {1, 1, 0}), 0.06, 0.03, 0.04)}};
}

/// Hits of rays half a pixel apart, with a margin around the image.
class CastImage {
 public:
  CastImage(const Scene& scene, const Camera& camera)
      : hits_(2 * (camera.intrinsics.width() + 2 * margin),
              2 * (camera.intrinsics.height() + 2 * margin)) {
    for (const auto [i, j] : each_pixel(hits_))
      hits_(i, j) = scene.hit(camera, 0.5 * i - margin, 0.5 * j - margin);
  }

  /// Returns the range of depths if all rays within `reach` pixels hit the surface `index`.
  [[nodiscard]] std::optional<std::pair<double, double>> surface(const Vector2d& pixel,
                                                                 double reach,
                                                                 std::size_t index) const {
    const int i = int(std::lround(2 * (pixel.x() + margin)));
    const int j = int(std::lround(2 * (pixel.y() + margin)));
    const int r = int(std::ceil(2 * reach));
    if (i < r || j < r || i + r >= hits_.width() || j + r >= hits_.height()) return std::nullopt;
    std::pair<double, double> span{1e9, 0};
    for (int y = j - r; y <= j + r; ++y)
      for (int x = i - r; x <= i + r; ++x) {
        if (hits_(x, y).index != index) return std::nullopt;
        span = {std::min(span.first, hits_(x, y).depth), std::max(span.second, hits_(x, y).depth)};
      }
    return span;
  }

 private:
  static constexpr int margin = 4;
  Image<Hit> hits_;
};

struct Pair {
  std::string name;
  Camera from, to;
  Isometry3d T_to_from;
};

/// Returns the pixel of a point in the camera's frame; nothing if the lens does not reach it.
std::optional<Vector2d> pixel_of(const Camera& camera, const Vector3d& point) {
  if (point.z() <= 0.05) return std::nullopt;
  const Vector2d ray = point.head<2>() / point.z();
  if (ray.norm() >= camera.distortion.max_radius()) return std::nullopt;
  const Vector2d seen = camera.distortion.distort(ray);
  return camera.intrinsics.project({seen.x(), seen.y(), 1});
}

struct Score {
  std::size_t measured = 0;
  std::size_t made_up = 0;  ///< of `measured`: without such a depth nearby in the source
  std::size_t checked = 0;  ///< pixels that must be measured
  std::size_t holes = 0;    ///< of `checked`: not measured
  std::size_t off = 0;      ///< of `checked`: not a depth of the surface near that pixel
};

class Judge {
 public:
  /// `source`: what the first camera measured, metres.
  Judge(const Pair& pair, const Scene& scene, const Image<float>& source, double tolerance)
      : pair_(pair),
        scene_(scene),
        scene_to_(scene.seen_from(pair.T_to_from)),
        from_(scene, pair.from),
        to_(scene_to_, pair.to),
        depths_to_(source.width(), source.height()),
        tolerance_(tolerance) {
    for (const auto [u, v] : each_pixel(source))
      if (const auto point = point_of(pair.from, Vector2d(u, v), source(u, v)))
        depths_to_(u, v) = source(u, v) > 0 ? (pair.T_to_from * *point).z() : 0.0;
  }

  template <typename Value>
  [[nodiscard]] Score operator()(ImageView<const Value> warped, double unit) const {
    Score score;
    for (int v = 0; v < warped.height; v += sample_stride)
      for (int u = 0; u < warped.width; ++u)
        add(Vector2d(u, v), unit * double(warped(u, v)), score);
    return score;
  }

 private:
  static std::optional<Vector3d> point_of(const Camera& camera, const Vector2d& pixel,
                                          double depth) {
    const auto ray =
        camera.distortion.undistort(camera.intrinsics.ray(pixel.x(), pixel.y()).head<2>());
    if (!ray) return std::nullopt;
    return Vector3d(ray->x() * depth, ray->y() * depth, depth);
  }

  void add(const Vector2d& pixel, double measured, Score& score) const {
    if (measured > 0) {
      ++score.measured;
      if (!source_has(pixel, measured)) ++score.made_up;
    }
    const Hit hit = scene_to_.hit(pair_.to, pixel.x(), pixel.y());
    if (hit.index == 0) return;
    // Two pixels of the source, as wide as they are here.
    const double wide = std::max(1.0, pair_.to.intrinsics.fx() / pair_.from.intrinsics.fx());
    const auto here = to_.surface(pixel, 2 * wide, hit.index);
    if (!here || !source_sees(pixel, hit)) return;
    ++score.checked;
    // Rays half a pixel apart miss the very edge between two faces of a box.
    const double margin = tolerance_ + 0.1 * (here->second - here->first);
    if (measured == 0)
      ++score.holes;
    else if (measured < here->first - margin || measured > here->second + margin)
      ++score.off;
  }

  /// Whether a source pixel near the point's image has this depth.
  [[nodiscard]] bool source_has(const Vector2d& pixel, double depth) const {
    constexpr int reach = 4;  // a steep surface moves by some pixels between two of its pixels
    const auto point = point_of(pair_.to, pixel, depth);
    const auto seen = pixel_of(pair_.from, pair_.T_to_from.inverse() * *point);
    if (!seen) return false;
    const auto u0 = int(std::lround(seen->x()));
    const auto v0 = int(std::lround(seen->y()));
    for (int v = std::max(v0 - reach, 0); v <= std::min(v0 + reach, depths_to_.height() - 1); ++v)
      for (int u = std::max(u0 - reach, 0); u <= std::min(u0 + reach, depths_to_.width() - 1); ++u)
        if (std::abs(depths_to_(u, v) - depth) <= tolerance_) return true;
    return false;
  }

  /// Whether the first camera sees the same point as the second one, inside its surface.
  [[nodiscard]] bool source_sees(const Vector2d& pixel, const Hit& hit) const {
    const Vector3d point = pair_.T_to_from.inverse() * *point_of(pair_.to, pixel, hit.depth);
    const auto seen = pixel_of(pair_.from, point);
    const Intrinsics& k = pair_.from.intrinsics;
    if (!seen || seen->minCoeff() < 1 || seen->x() > k.width() - 2 || seen->y() > k.height() - 2)
      return false;
    const double nearest = scene_.hit(pair_.from, seen->x(), seen->y()).depth;
    return from_.surface(*seen, 2, hit.index) && std::abs(nearest - point.z()) < 1e-6;
  }

  const Pair& pair_;
  const Scene& scene_;
  Scene scene_to_;
  CastImage from_, to_;
  Image<double> depths_to_;  // of the source's pixels, in the second camera
  double tolerance_;
};

void expect_right(const Score& score) {
  EXPECT_EQ(score.made_up, 0U) << "of " << score.measured;
  EXPECT_EQ(score.holes, 0U) << "of " << score.checked;
  EXPECT_EQ(score.off, 0U) << "of " << score.checked;
  EXPECT_GT(score.checked, std::size_t(samples(4000)));
}

Camera with_lens(Camera camera, const Lens& lens) {
  camera.distortion = lens.distortion();
  return camera;
}

std::vector<Pair> pairs() {
  const Camera small = plain_camera(160, 120, 130);
  const Camera large = plain_camera(240, 180, 200);
  const auto lenses = typical_lenses();
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
    const Judge judge(pair, scene, metres, float_rounding);
    expect_right(judge(
        std::get<ImageView<const float>>(registration.warp(metres.view(), pair.T_to_from)), 1.0));

    const Image<std::uint16_t> millimetres = to_millimetres(metres);
    const Judge coarse(pair, scene, metres, millimetre_rounding);
    expect_right(coarse(std::get<ImageView<const std::uint16_t>>(
                            registration.warp(millimetres.view(), pair.T_to_from)),
                        1e-3));
  }
}

TEST(Registration, WhatIsNotMeasuredStaysSo) {
  const Camera camera = plain_camera(80, 60, 70);
  DepthRegistration registration(camera, camera);
  Image<float> depth(80, 60, 1.0F);
  const float none[] = {0.0F,   -1.0F, std::nanf(""), std::numeric_limits<float>::infinity(),
                        0.005F, 2e6F};
  for (int i = 0; i < 6; ++i) depth(10 + 5 * i, 30) = none[i];
  const auto same =
      std::get<ImageView<const float>>(registration.warp(depth.view(), Isometry3d::Identity()));
  for (const auto [u, v] : each_pixel(0, 0, 80, 60)) {
    const bool hole = v == 30 && u >= 10 && u <= 35 && u % 5 == 0;
    EXPECT_EQ(same(u, v), hole ? 0.0F : 1.0F) << u << ',' << v;
  }
}

}  // namespace
}  // namespace penumbra::test
