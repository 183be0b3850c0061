// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr auto unknown = static_cast<std::uint8_t>(Label::unknown);
constexpr double depth_tolerance = 1e-5;  // metres at 1 m: float32 and the renderer's own formula

/// The slab scene through a lens whose monotone radius leaves the image's corners out.
Camera lens_camera() {
  const double coefficients[] = {-0.3, 0.0, 0.001, -0.002, 0.0};
  Camera camera = slab_camera();
  camera.intrinsics = Intrinsics(161, 121, 95.0, 96.0, 73.21, 57.43);
  camera.distortion = Distortion("plumb_bob", coefficients);
  return camera;
}

/// What raw pixel (u, v) sees, by a ray cast through the lens model; nothing where it does not
/// reach.
std::optional<Seen> cast_raw(const Camera& camera, int u, int v, double slide) {
  const Eigen::Vector3d ray = camera.intrinsics.ray(u, v);
  const auto point = camera.distortion.undistort(ray.head<2>());
  if (!point) return std::nullopt;
  return cast({point->x(), point->y(), 1.0}, slide);
}

Image<Seen> cast_all(const Camera& camera, double slide) {
  const Intrinsics& k = camera.intrinsics;
  Image<Seen> seen(k.width(), k.height());
  for (int v = 0; v < k.height(); ++v)
    for (int u = 0; u < k.width(); ++u)
      seen(u, v) = cast_raw(camera, u, v, slide).value_or(Seen{0.0, -1});
  return seen;
}

/// What may be seen within one pixel of (u, v): mapping to the nearest pixel is off by less. Where
/// all of it is one link, its depth lies between.
struct Nearby {
  std::vector<int> links;
  double nearest = 1e9, farthest = 0.0;

  [[nodiscard]] bool is_silhouette() const {
    return std::count(links.begin(), links.end(), links[0]) != std::ssize(links);
  }
};

Nearby nearby(const Image<Seen>& seen, int u, int v) {
  Nearby found;
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, seen.height() - 1); ++y) {
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, seen.width() - 1); ++x) {
      found.links.push_back(seen(x, y).link);
      found.nearest = std::min(found.nearest, seen(x, y).depth);
      found.farthest = std::max(found.farthest, seen(x, y).depth);
    }
  }
  return found;
}

TEST(Lens, RawImagesShowWhatRaysThroughTheLensMeet) {
  const Camera camera = lens_camera();
  Pipeline pipeline(slab_robot(), camera, plain_config());
  for (const double slide : {0.0, -0.45, 0.2}) {
    const std::vector<double> positions = {slide};
    const FrameReport& report = pipeline.process({.joints = positions});
    const Image<Seen> seen = cast_all(camera, slide);
    std::size_t uncovered = 0;
    for (int v = 0; v < seen.height(); ++v) {
      for (int u = 0; u < seen.width(); ++u) {
        const float depth = report.virtual_depth.depth(u, v);
        const int link = report.virtual_depth.links(u, v);
        if (seen(u, v).link < 0) {
          ++uncovered;
          ASSERT_EQ(report.labels(u, v), unknown) << u << ',' << v;
          ASSERT_EQ(depth, 0.0F);
          continue;
        }
        ASSERT_EQ(report.labels(u, v), depth > 0.0F ? unknown : 0) << u << ',' << v;
        const Nearby near = nearby(seen, u, v);
        ASSERT_NE(std::count(near.links.begin(), near.links.end(), link), 0) << u << ',' << v;
        if (near.is_silhouette()) continue;
        ASSERT_GE(depth, near.nearest - depth_tolerance) << u << ',' << v;
        ASSERT_LE(depth, near.farthest + depth_tolerance) << u << ',' << v;
      }
    }
    EXPECT_GT(uncovered, 100U) << "the corners";
    EXPECT_EQ(report.pixels.uncovered, uncovered);
    EXPECT_EQ(report.pixels.unknown, uncovered + report.pixels.robot.value());
  }
}

TEST(Lens, RawDepthIsComparedWhereItWasMeasured) {
  const Camera camera = lens_camera();
  const Image<Seen> seen = cast_all(camera, 0.0);
  Image<float> depth(seen.width(), seen.height(), static_cast<float>(wall_depth));
  const auto is_object = [](int u, int v) { return u >= 60 && u < 75 && v >= 50 && v < 62; };
  for (int v = 0; v < seen.height(); ++v) {
    for (int u = 0; u < seen.width(); ++u) {
      if (seen(u, v).depth > 0.0) depth(u, v) = static_cast<float>(seen(u, v).depth);
      if (is_object(u, v)) depth(u, v) = 0.6F;
    }
  }
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const std::vector<double> positions = {0.0};
  const FrameReport& report = pipeline.process({.depth = depth.view(), .joints = positions});
  EXPECT_EQ(report.pixels.front, 15U * 12U);
  for (int v = 0; v < seen.height(); ++v) {
    for (int u = 0; u < seen.width(); ++u) {
      const bool front = report.labels(u, v) == static_cast<std::uint8_t>(Label::front);
      ASSERT_EQ(front, is_object(u, v)) << u << ',' << v;
    }
  }
}

TEST(Lens, RectifiedImagesArePinholeImages) {
  const Camera camera = lens_camera();
  PipelineConfig config = plain_config();
  config.image = ImageSpace::rectified;
  Pipeline pipeline(slab_robot(), camera, config);
  const Intrinsics& k = pipeline.intrinsics();
  ASSERT_NE(pipeline.rectification(), nullptr);
  const auto to_raw = pipeline.rectification()->pinhole_to_raw();
  const Image<float> wall(camera.intrinsics.width(), camera.intrinsics.height(), 0.9F);
  const std::vector<double> positions = {0.0};
  const FrameReport& report = pipeline.process({.depth = wall.view(), .joints = positions});
  ASSERT_EQ(report.labels.width, k.width());
  std::size_t robot = 0;
  for (int v = 0; v < k.height(); ++v) {
    for (int u = 0; u < k.width(); ++u) {
      const Seen seen = cast(k.ray(u, v), 0.0);
      ASSERT_NEAR(report.virtual_depth.depth(u, v), seen.depth, depth_tolerance) << u << ',' << v;
      const bool measured = to_raw(u, v) != Rectification::no_pixel;
      const auto label = static_cast<std::uint8_t>(measured ? Label::front : Label::unknown);
      ASSERT_EQ(report.labels(u, v), seen.depth > 0.0 ? label : 0) << u << ',' << v;
      robot += seen.depth > 0.0 ? 1 : 0;
    }
  }
  EXPECT_EQ(report.pixels.robot, robot);
  EXPECT_EQ(report.pixels.uncovered, 0U);
}

TEST(Lens, ALensWithoutDistortionChangesNothing) {
  PipelineConfig config = plain_config();
  config.image = ImageSpace::rectified;
  const Pipeline pipeline(slab_robot(), slab_camera(), config);
  EXPECT_EQ(pipeline.intrinsics(), slab_camera().intrinsics);
  EXPECT_EQ(pipeline.rectification(), nullptr);
}

}  // namespace
}  // namespace penumbra::test
