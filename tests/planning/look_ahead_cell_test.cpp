// SPDX-License-Identifier: Apache-2.0
// Looking ahead in a cell whose depth a formula tells: targets in pixels, several cameras, carried
// bodies, the clearance against all pairs of pixels, and the interpolation of trajectories.
#include "../pipeline/slab_scene.hpp"

#include <penumbra/mesh/primitives.hpp>
#include <penumbra/planning/look_ahead.hpp>

namespace penumbra::test {
namespace {

const std::vector<std::string> slide_joint = {"slide"};

ForecastCamera cell_camera(const Vector3d& at = Vector3d::Zero()) {
  ForecastCamera camera{.name = "cell", .camera = slab_camera()};
  camera.camera.T_parent_camera->translation() = at;
  return camera;
}

ForecastTarget box_target(const PixelBox& box, std::optional<double> depth, Extent extent) {
  return {
      .target = {.name = "box",
                 .shape = RegionTarget{.region = box, .extent = extent, .expected_depth = depth}}};
}

ForecastTarget ball_target(const Vector3d& at) {
  return {.target = {.name = "ball", .shape = PointTarget{at, 0.03, ReferenceFrame::root()}}};
}

/// What is foreseen of a target while the robot rests for some time.
TargetForecast forecast(const std::vector<ForecastCamera>& cameras, const ForecastTarget& target,
                        const RobotPose& start = {.positions = {0.0}}, double seconds = 0.0) {
  std::vector<TrajectoryPoint> rest{{.time = 0.0, .positions = {0.0}}};
  if (seconds > 0.0) rest.push_back({.time = seconds, .positions = {0.0}});
  const Trajectory trajectory(slab_robot(), slide_joint, rest, std::vector{0.0});
  return LookAhead(slab_robot(), cameras, {target}, start).along(trajectory).front();
}

VerdictInterval first_interval(const std::vector<ForecastCamera>& cameras,
                               const ForecastTarget& target,
                               const RobotPose& start = {.positions = {0.0}}) {
  return forecast(cameras, target, start).any.intervals[0];
}

TEST(LookAheadClearance, IsTheDistanceOfAllPairsOfPixels) {
  const Intrinsics image = slab_camera().intrinsics;
  std::vector<Eigen::Vector2i> robot;  // pixels
  for (const auto [u, v] : each_pixel(image))
    if (cast(image.ray(u, v), 0.0).link != 0) robot.emplace_back(u, v);
  const LookAheadConfig config{.clearance = 20};
  std::mt19937_64 random = seeded_random(392);
  std::size_t negative = 0, positive = 0;
  for (int i = 0; i < 60; ++i) {
    const auto whole = [&](int low, int high) {
      return std::uniform_int_distribution(low, high)(random);
    };
    const PixelBox box{double(whole(0, image.width() - 12)), double(whole(0, image.height() - 12)),
                       double(whole(3, 12)), double(whole(3, 12))};
    LookAhead ahead(slab_robot(), {cell_camera()}, {box_target(box, 2.0, Extent::amodal)},
                    {.positions = {0.0}}, config);
    const float got = ahead.visibility(0, std::vector{0.0}).front().clearance;
    const auto is_target = [&](const Eigen::Vector2i& p) {
      return p.x() >= box.u && p.x() < box.u + box.width && p.y() >= box.v &&
             p.y() < box.v + box.height;
    };
    double nearest = config.clearance + 1, deepest = 0.0;
    for (const Eigen::Vector2i& p : robot) {
      if (is_target(p)) {
        double free = config.clearance;
        for (int dv = -config.clearance; dv <= config.clearance; ++dv)
          for (int du = -config.clearance; du <= config.clearance; ++du) {
            const Eigen::Vector2i q = p + Eigen::Vector2i(du, dv);
            const bool inside =
                q.x() >= 0 && q.y() >= 0 && q.x() < image.width() && q.y() < image.height();
            if (inside && cast(image.ray(q.x(), q.y()), 0.0).link == 0)
              free = std::min(free, std::hypot(du, dv));
          }
        deepest = std::max(deepest, free);
      }
      for (double v = box.v; v < box.v + box.height; ++v)
        for (double u = box.u; u < box.u + box.width; ++u)
          nearest = std::min(nearest, std::hypot(u - p.x(), v - p.y()));
    }
    const double wanted = deepest > 0.0 ? -deepest : nearest - 1.0;
    EXPECT_NEAR(got, wanted, 1e-5)
        << box.u << ' ' << box.v << ' ' << box.width << ' ' << box.height;
    ++(wanted < 0.0 ? negative : positive);
  }
  EXPECT_GT(negative, 5U);
  EXPECT_GT(positive, 5U);
}

TEST(LookAheadCell, PixelsWithoutDepthAreUnknownBehindTheRobot) {
  const PixelBox box{70, 54, 5, 5};  // behind the slab
  EXPECT_EQ(first_interval({cell_camera()}, box_target(box, 2.0, Extent::amodal)).verdict,
            Verdict::hidden);
  for (const auto& target :
       {box_target(box, std::nullopt, Extent::amodal), box_target(box, 2.0, Extent::modal)}) {
    const VerdictInterval seen = first_interval({cell_camera()}, target);
    EXPECT_EQ(seen.verdict, Verdict::unknown);
    EXPECT_NE(seen.reason, "");
  }
}

TEST(LookAheadCell, PixelsOfOneCameraAreUnknownInAnother) {
  const ForecastTarget corner = box_target({1, 1, 4, 4}, std::nullopt, Extent::amodal);
  const TargetForecast seen = forecast({cell_camera(), cell_camera({0.5, 0.0, 0.0})}, corner);
  EXPECT_EQ(seen.cameras[0].intervals[0].verdict, Verdict::visible);
  EXPECT_EQ(seen.cameras[1].intervals[0].verdict, Verdict::unknown);
}

TEST(LookAheadCell, OneCameraThatSeesItIsEnough) {
  const ForecastTarget behind = ball_target({0.05, 0.02, 1.6});
  EXPECT_EQ(first_interval({cell_camera()}, behind).verdict, Verdict::hidden);
  EXPECT_EQ(first_interval({cell_camera(), cell_camera({0.0, 0.0, 1.3})}, behind).verdict,
            Verdict::visible);
}

TEST(LookAheadCell, WhatIsCarriedHidesAndIsHeld) {
  const ForecastTarget ball = ball_target({-0.6, -0.3, 1.4});
  EXPECT_EQ(first_interval({cell_camera()}, ball).verdict, Verdict::visible);
  RobotPose carrying{.positions = {0.0}};
  carrying.attached = {
      {.name = "part",
       .link = "slab",
       .mesh = std::make_shared<PreparedMesh>(make_box(Vector3d(3.0, 3.0, 0.05)))}};
  const VerdictInterval hidden = first_interval({cell_camera()}, ball, carrying);
  EXPECT_EQ(hidden.verdict, Verdict::hidden);
  EXPECT_EQ(hidden.by, "part");
  carrying.attached[0].name = "ball";
  EXPECT_EQ(first_interval({cell_camera()}, ball, carrying).verdict, Verdict::held);
  carrying.attached[0].name = "part";
  carrying.attached[0].mesh = nullptr;
  EXPECT_EQ(first_interval({cell_camera()}, ball, carrying).verdict, Verdict::unknown);
}

TEST(LookAheadCell, ATargetMovesOutOfTheShadow) {
  ForecastTarget ball = ball_target({0.05, 0.02, 1.6});
  ball.velocity = {-1.0, -0.5, 0.0};
  const TargetForecast seen = forecast({cell_camera()}, ball, {.positions = {0.0}}, 0.8);
  EXPECT_EQ(seen.any.hidden_at(), 0.0);
  EXPECT_TRUE(seen.any.seen_again_at().has_value());
}

/// A polynomial's value by Horner's scheme.
double value_at(double t, const std::vector<double>& c) {
  return std::accumulate(c.rbegin(), c.rend(), 0.0,
                         [&](double sum, double a) { return sum * t + a; });
}

std::vector<double> derivative(std::vector<double> c) {
  for (std::size_t i = 0; i < c.size(); ++i) c[i] *= double(i);
  c.erase(c.begin());
  return c;
}

TEST(Trajectory, FollowsPolynomialsOfItsDegree) {
  const std::vector<std::vector<double>> polynomials = {
      {0.1, 0.3}, {0.1, 0.3, -0.2, 0.15}, {0.1, 0.3, -0.2, 0.15, 0.05, -0.02}};
  for (const std::vector<double>& c : polynomials) {
    std::vector<TrajectoryPoint> points;
    for (const double t : {0.0, 0.7, 1.5}) {
      points.push_back({.time = t, .positions = {value_at(t, c)}});
      const std::vector<double> velocity = derivative(c);
      if (c.size() > 2) points.back().velocities = {value_at(t, velocity)};
      if (c.size() > 4) points.back().accelerations = {value_at(t, derivative(velocity))};
    }
    const Trajectory trajectory(slab_robot(), slide_joint, points, std::vector{0.1});
    for (double t = 0.0; t <= 1.5; t += 0.05) {
      std::vector<double> positions(1);
      trajectory.at(t, positions);
      EXPECT_NEAR(positions[0], value_at(t, c), 1e-12) << t;
    }
  }
}

}  // namespace
}  // namespace penumbra::test
