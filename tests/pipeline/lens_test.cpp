// SPDX-License-Identifier: Apache-2.0
#include "../camera/lens_samples.hpp"
#include "slab_scene.hpp"

namespace penumbra::test {
namespace {

/// Its monotone radius leaves the image's corners out.
const Lens narrow_lens{"without corners", "plumb_bob", {-0.3, 0.0, 0.001, -0.002, 0.0}};

/// Of the slab scene.
Camera lens_camera(const Lens& lens = narrow_lens) {
  Camera camera = camera_at_root(Intrinsics(161, 121, 95.0, 96.0, 73.21, 57.43));
  camera.distortion = lens.distortion();
  return camera;
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

/// In the raw image of a lens a rendered box covers the pixels whose rays meet it, and the robot
/// hides those whose rays meet the robot.
TEST(TargetsInTheRawImage, OfARenderedBoxAreThoseThatTheirRaysMeet) {
  Camera camera = slab_camera();
  camera.distortion = Distortion("plumb_bob", std::array{-0.25, 0.06, 0.001, -0.001, 0.0});
  const Image<float> depth = scene_depth(camera, 0.0);
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const Vector3d middle(0.40, 0.05, 1.5), size(0.6, 0.5, 0.001);
  Target target{.name = "plate", .shape = BoxTarget{at(middle), size, {}}};
  target.thresholds.past_limit = 1;  // the wall is what is measured
  const FrameReport& report = pipeline.process(frame_of(depth, 0.0, {target}));
  int covered = 0, hidden = 0;
  for (const auto [u, v] : each_pixel(depth)) {
    const Vector3d straight = camera.intrinsics.ray(u, v);
    const auto ray = camera.distortion.undistort(straight.head<2>());
    if (!ray) continue;
    const Vector2d off = 1.4995 * *ray - middle.head<2>();
    if (std::abs(off.x()) > size.x() / 2 || std::abs(off.y()) > size.y() / 2) continue;
    ++covered;
    if (cast({ray->x(), ray->y(), 1.0}, 0.0).depth > 0.0) ++hidden;
  }
  // Raw images are drawn through the pinhole image: outlines may be off by a pixel.
  const TargetReport& plate = report.targets[0];
  ASSERT_TRUE(plate.judgement) << plate.reason;
  constexpr double outline = 0.04;  // of the plate's pixels
  EXPECT_GT(covered, 1500);
  EXPECT_GT(hidden, 300);
  EXPECT_NEAR(double(plate.judgement->inside), covered, outline * covered);
  EXPECT_NEAR(plate.judgement->occluded, hidden / (1.0 * covered), outline);
  EXPECT_EQ(plate.verdict, Verdict::partial);
}

/// Pixels of a fisheye's image whose rays meet a sphere, by the formula of equidistant lenses: also
/// of rays that no pinhole image holds.
int pixels_of_sphere(const Intrinsics& k, const Vector3d& middle, double radius) {
  const double spread = std::asin(radius / middle.norm());
  int pixels = 0;
  for (const auto [u, v] : each_pixel(k)) {
    const Vector2d bent = k.ray(u, v).head<2>();
    const double angle = bent.norm();
    Vector3d ray(0, 0, std::cos(angle));
    if (angle > 0.0) ray.head<2>() = bent * (std::sin(angle) / angle);
    if (std::acos(std::clamp(ray.dot(middle.normalized()), -1.0, 1.0)) <= spread) ++pixels;
  }
  return pixels;
}

/// A radius in metres takes in what a lens stretches: no less than the same disc's ellipse.
TEST(TargetsInTheRawImage, OfARadiusInMetresGrowWithTheLens) {
  Camera camera = slab_camera();
  camera.distortion = Distortion("plumb_bob", std::array{0.3, 0.0, 0.0, 0.0, 0.0});
  const Image<float> depth = scene_depth(camera, 0.0);
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const Vector3d middle(0.75, 0.6, 1.5);
  const Vector2d bent = camera.distortion.distort(middle.head<2>() / middle.z());
  const Vector2d pixel = camera.intrinsics.project({bent.x(), bent.y(), 1.0});
  constexpr double radius = 0.1;
  KeypointTarget key{.pixel = pixel, .semi_axes = Vector2d::Constant(radius)};
  key.in_metres = true;
  key.expected_depth = middle.z();
  const std::vector<Target> targets{{.name = "key", .shape = key},
                                    {.name = "point", .shape = PointTarget{middle, radius, {}}}};
  const FrameReport& report = pipeline.process(frame_of(depth, 0.0, targets));
  ASSERT_TRUE(report.targets[0].judgement && report.targets[1].judgement);
  const std::size_t disc = report.targets[1].judgement->covered;
  EXPECT_GT(disc, 300U);
  EXPECT_GE(report.targets[0].judgement->covered, disc);
  EXPECT_LT(report.targets[0].judgement->covered, 2 * disc);
}

Camera fisheye(double focal) {
  const Intrinsics k = slab_camera().intrinsics;
  Camera camera = camera_at_root(
      Intrinsics(k.width(), k.height(), focal, focal, k.width() / 2.0, k.height() / 2.0));
  camera.distortion = Distortion("equidistant", std::array{0.0, 0.0, 0.0, 0.0});
  return camera;
}

struct FisheyeCounts {
  int undrawn = 0, out_of_view = 0, whole = 0;
};

/// Cubes all around a fisheye of that focal length, pixels. Those that reach beyond its pinhole
/// image must not look visible, nor out of view where they are seen.
FisheyeCounts judge_around_fisheye(double focal) {
  const Camera camera = fisheye(focal);
  const int width = camera.intrinsics.width(), height = camera.intrinsics.height();
  const Image<float> depth(width, height, float(wall_depth));
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const double covered = Rectification(camera).half_angle();
  constexpr double radius = 0.15, inner = radius / std::numbers::sqrt3;  // spheres around and in it
  FisheyeCounts counts;
  for (double angle = 0.2; angle < 2.8; angle += 0.05)
    for (double about = 0.0; about < 6.28; about += 0.35) {
      Isometry3d pose =
          at(std::sin(angle) * std::cos(about), std::sin(angle) * std::sin(about), std::cos(angle));
      const int pixels = pixels_of_sphere(camera.intrinsics, pose.translation(), inner);
      Target target{.name = "cube", .shape = BoxTarget{pose, Vector3d::Constant(2.0 * inner), {}}};
      target.thresholds.past_limit = 1;  // the wall is what is measured
      pipeline.forget_targets();
      const TargetReport& report = pipeline.process(frame_of(depth, 0.0, {target})).targets[0];
      SCOPED_TRACE(testing::Message() << angle << " about " << about << ": " << pixels);
      const bool is_undrawn = report.reason.find("cannot be rendered") != std::string_view::npos;
      if (pixels > 0 && angle + std::asin(inner) > covered) {
        EXPECT_NE(report.verdict, Verdict::visible);
        EXPECT_NE(report.verdict, Verdict::out_of_view);
      }
      if (angle + 1.1 * radius < covered) {
        EXPECT_FALSE(is_undrawn);
      }
      counts.undrawn += is_undrawn ? 1 : 0;
      counts.out_of_view += report.verdict == Verdict::out_of_view ? 1 : 0;
      counts.whole += pixels > 0 && report.judgement && !is_undrawn ? 1 : 0;
    }
  return counts;
}

TEST(TargetsOfAFisheye, AreUnknownWhereTheyReachBeyondThePinholeImage) {
  const FisheyeCounts counts = judge_around_fisheye(40.0);  // to 115 degrees from its axis
  EXPECT_GT(counts.undrawn, 100);
  EXPECT_GT(counts.whole, 100);
}

TEST(TargetsOfAFisheye, AreOutOfViewBesideANarrowOne) {
  const FisheyeCounts counts = judge_around_fisheye(130.0);  // to 36 degrees: all is drawn
  EXPECT_EQ(counts.undrawn, 0);
  EXPECT_GT(counts.out_of_view, 100);
  EXPECT_GT(counts.whole, 20);
}

/// A plate of the robot that none of a fisheye's drawn pixels shows may hide what ends beside them.
TEST(TargetsOfAFisheye, BesideWhatCannotBeDrawnAreAsBesideTheRobot) {
  const Camera camera = fisheye(40.0);
  const int width = camera.intrinsics.width(), height = camera.intrinsics.height();
  const Rectification rectification(camera);
  const auto drawn = rectification.raw_to_pinhole();
  int end = width / 2;  // of the drawn pixels in the middle row
  while (drawn(end, height / 2) != Rectification::no_pixel) ++end;
  ASSERT_LT(end, width - 5);
  Pipeline pipeline(slab_robot(), camera, plain_config());
  const Image<float> depth(width, height, float(wall_depth));
  const auto box = [&](double u) { return PixelBox{u, height / 2.0 - 4, 6, 8}; };
  const double beside = end - 7.0;
  Target modal = region("modal", box(beside)), far = region("far", PixelBox{77, 78, 6, 8});
  std::get<RegionTarget>(modal.shape).extent = Extent::modal;
  const std::vector<Target> targets{modal, far, region("beside", box(beside)),
                                    region("in it", box(end + 1.0))};
  // The slab is small, in the middle.
  const FrameReport& report = pipeline.process(frame_of(depth, 0.9, targets));
  using enum Verdict;
  expect_verdicts(report, {unknown, visible, visible, unknown});  // amodal: all of it is seen
  EXPECT_TRUE(report.targets[1].point);
  EXPECT_FALSE(report.targets[2].point) << "depths there may be of robot that is not drawn";
  EXPECT_TRUE(holds(report.targets[3].reason, "lens model"));
}

/// Of a lens whose pinhole image reaches far beyond what the camera saw.
TEST(RectifiedTargetsTest, AreInViewWhereTheyAreInTheRawImage) {
  Camera camera = slab_camera();
  camera.distortion = Distortion("plumb_bob", std::array{-0.3, 0.0, 0.0, 0.0, 0.0});
  const Image<float> depth(camera.intrinsics.width(), camera.intrinsics.height(),
                           float(wall_depth));
  PipelineConfig config = plain_config();
  Pipeline raw(slab_robot(), camera, config);
  config.image = ImageSpace::rectified;
  Pipeline rectified(slab_robot(), camera, config);
  int in_view = 0, out_of_view = 0;
  for (double x = -1.5; x <= 1.5; x += 0.125)
    for (double y = -1.2; y <= 1.2; y += 0.125) {
      const auto is_seen = [&](Pipeline& by, double scale) {
        const Vector3d position(scale * x, scale * y, 1.0);
        by.forget_targets();
        const Target target{.name = "point", .shape = PointTarget{position, 0.002, {}}};
        const TargetReport& report = by.process(frame_of(depth, 0.0, {target})).targets[0];
        return report.verdict != Verdict::out_of_view &&  // the raw image's corners are not covered
               report.reason.find("cannot be rendered") == std::string_view::npos;
      };
      const bool in_raw = is_seen(raw, 1.0);
      if (is_seen(raw, 0.98) != is_seen(raw, 1.02)) continue;  // within two pixels of the edge
      EXPECT_EQ(is_seen(rectified, 1.0), in_raw) << x << ", " << y;
      (in_raw ? in_view : out_of_view) += 1;
    }
  EXPECT_GT(in_view, 50);
  EXPECT_GT(out_of_view, 50);
}

}  // namespace
}  // namespace penumbra::test
