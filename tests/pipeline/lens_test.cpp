// SPDX-License-Identifier: Apache-2.0
#include "../camera/lens_samples.hpp"
#include "slab_scene.hpp"

namespace penumbra::test {
namespace {

/// Its monotone radius leaves the image's corners out.
const Lens narrow_lens{"without corners", "plumb_bob", {-0.3, 0.0, 0.001, -0.002, 0.0}};

/// Of the slab scene.
Camera lens_camera(const Lens& lens = narrow_lens) {
  return {Intrinsics(161, 121, 95.0, 96.0, 73.21, 57.43), lens.distortion(), {}, {}};
}

/// What each raw pixel sees, by a ray cast through the lens model; link -1 where no pinhole image
/// reaches.
Image<Seen> cast_all(const Camera& camera, double slide) {
  const Intrinsics& k = camera.intrinsics;
  const double reach = Rectification(camera).half_angle();
  Image<Seen> seen(k.width(), k.height(), Seen{0.0, -1});
  for (const auto [u, v] : each_pixel(k))
    if (const auto ray = camera.distortion.undistort(k.ray(u, v).head<2>());
        ray && std::atan(ray->norm()) <= reach)
      seen(u, v) = cast({ray->x(), ray->y(), 1.0}, slide);
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
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, seen.height() - 1); ++y)
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, seen.width() - 1); ++x) {
      found.links.push_back(seen(x, y).link);
      found.nearest = std::min(found.nearest, seen(x, y).depth);
      found.farthest = std::max(found.farthest, seen(x, y).depth);
    }
  return found;
}

/// Expects an image of no measurement that shows what rays through the lens meet. Returns the
/// pixels that the lens does not reach.
std::size_t expect_cast(const FrameReport& report, const Image<Seen>& seen) {
  std::size_t uncovered = 0, wrong = 0;
  for (const auto [u, v] : each_pixel(seen)) {
    const float depth = report.virtual_depth.depth(u, v);
    if (seen(u, v).link < 0) {
      ++uncovered;
      wrong += report.labels(u, v) != unknown_label || depth != 0.0F ? 1 : 0;
      continue;
    }
    wrong += report.labels(u, v) != (depth > 0.0F ? unknown_label : 0) ? 1 : 0;
    const Nearby near = nearby(seen, u, v);
    const int link = report.virtual_depth.links(u, v);
    wrong += std::count(near.links.begin(), near.links.end(), link) == 0 ? 1 : 0;
    if (near.is_silhouette()) continue;
    const auto z = double(depth);
    wrong += z < near.nearest - depth_tolerance || z > near.farthest + depth_tolerance ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(report.pixels.uncovered, uncovered);
  EXPECT_EQ(report.pixels.unknown, report.pixels.robot) << "uncovered pixels stand apart";
  return uncovered;
}

TEST(Lens, RawImagesShowWhatRaysThroughTheLensMeet) {
  std::size_t uncovered = 0;
  std::vector<Lens> lenses = typical_lenses();
  lenses.push_back(narrow_lens);
  for (const Lens& lens : lenses) {
    SCOPED_TRACE(lens.name);
    const Camera camera = lens_camera(lens);
    PipelineConfig config = plain_config();
    config.has_depth = false;
    Pipeline pipeline(slab_robot(), camera, config);
    for (const double slide : {0.0, -0.45, 0.2})
      uncovered +=
          expect_cast(pipeline.process({.pose = {.positions = {slide}}}), cast_all(camera, slide));
  }
  EXPECT_GT(uncovered, 1000U) << "corners of some";
}

TEST(Lens, RawDepthIsComparedWhereItWasMeasured) {
  const Camera camera = lens_camera();
  const Image<Seen> seen = cast_all(camera, 0.0);
  Image<float> depth(seen.width(), seen.height(), float(wall_depth));
  const auto is_object = [](int u, int v) { return u >= 60 && u < 75 && v >= 50 && v < 62; };
  for (const auto [u, v] : each_pixel(seen)) {
    if (seen(u, v).depth > 0.0) depth(u, v) = float(seen(u, v).depth);
    if (is_object(u, v)) depth(u, v) = 0.6F;
  }
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const FrameReport& report = pipeline.process(frame_of(depth));
  EXPECT_EQ(report.pixels.front, 15U * 12U);
  for (const auto [u, v] : each_pixel(seen)) {
    const bool front = report.labels(u, v) == std::uint8_t(Label::front);
    ASSERT_EQ(front, is_object(u, v)) << u << ',' << v;
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
  const FrameReport& report = pipeline.process(frame_of(wall));
  ASSERT_EQ(report.labels.width, k.width());
  std::size_t robot = 0, hidden = 0, uncovered = 0;
  for (const auto [u, v] : each_pixel(k)) {
    const Seen seen = cast(k.ray(u, v), 0.0);
    ASSERT_NEAR(report.virtual_depth.depth(u, v), seen.depth, depth_tolerance) << u << ',' << v;
    const bool measured = to_raw(u, v) != Rectification::no_pixel, is_robot = seen.depth > 0.0;
    const Label label = !measured ? Label::unknown : is_robot ? Label::front : Label::clear;
    ASSERT_EQ(report.labels(u, v), std::uint8_t(label)) << u << ',' << v;
    robot += is_robot ? 1 : 0;
    hidden += is_robot && !measured ? 1 : 0;
    uncovered += !is_robot && !measured ? 1 : 0;
  }
  EXPECT_EQ(report.pixels.robot, robot);
  EXPECT_GT(uncovered, 100U) << "what the camera never saw";
  EXPECT_EQ(report.pixels.uncovered, uncovered);
  EXPECT_EQ(report.pixels.unknown, hidden);
}

}  // namespace
}  // namespace penumbra::test
