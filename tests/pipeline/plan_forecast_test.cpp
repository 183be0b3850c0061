// SPDX-License-Identifier: Apache-2.0
// Forecasts of a planned motion in the reports of frames, in a scene whose depth a formula tells.
#include "slab_scene.hpp"

#include <penumbra/planning/plan_forecast.hpp>
#include <penumbra/session/session.hpp>

namespace penumbra::test {
namespace {

constexpr double expected_depth = 2.0;  // metres: behind the slab, before the wall
constexpr double plan_length = 3.0;     // seconds
constexpr double forecast_tolerance =
    0.012;  // seconds: LookAheadConfig::border, and steps of 10 ms
constexpr double far_slide = 0.9, near_slide = 0.0;
const PixelBox beside{89, 54, 6, 6};  // free while the slab is far

double planned_slide(double time) { return std::lerp(far_slide, near_slide, time / plan_length); }

/// The plan from a time on.
std::shared_ptr<const Trajectory> plan_from(double time) {
  return std::make_shared<const Trajectory>(
      slab_robot(), std::vector<std::string>{"slide"},
      std::vector<TrajectoryPoint>{{.time = 0.0, .positions = {planned_slide(time)}},
                                   {.time = plan_length - time, .positions = {near_slide}}},
      std::vector{far_slide});
}

/// The share of the box before which the slab is.
double hidden_share(double slide) {
  int hidden = 0, all = 0;
  for (double v = beside.v; v < beside.v + beside.height; ++v)
    for (double u = beside.u; u < beside.u + beside.width; ++u, ++all) {
      const Seen seen = cast(slab_camera().intrinsics.ray(u, v), slide);
      hidden += seen.link != 0 && seen.depth < expected_depth ? 1 : 0;
    }
  return double(hidden) / all;
}

/// When on the plan the box gets hidden, to a millisecond.
double hidden_from() {
  double time = 0.0;
  while (hidden_share(planned_slide(time)) <= TargetThresholds{}.hidden_enter) time += 0.001;
  return time;
}

class PlanForecasts : public testing::Test {
 protected:
  const TargetReport& judge(double slide, std::shared_ptr<const Trajectory> plan,
                            std::optional<std::int64_t> stamp = {}, const PixelBox& box = beside) {
    depth = scene_depth(slab_camera(), slide);
    Frame frame =
        frame_of(depth, slide,
                 {{.name = "box", .shape = RegionTarget{box, Extent::amodal, expected_depth}}});
    frame.stamp = stamp;
    frame.plan = std::move(plan);
    return session.process(frame).targets[0];
  }

  Session session{slab_robot(), slab_camera(), plain_config()};
  Image<float> depth;
};

std::optional<double> seconds_until_hidden(const TargetReport& report) {
  for (const VerdictInterval& each : report.forecast)
    if (each.verdict == Verdict::hidden) return each.begin;
  return std::nullopt;
}

TEST_F(PlanForecasts, FollowTheRobotOnItsPlan) {
  const auto plan = plan_from(0.0);
  const double truth = hidden_from();
  ASSERT_GT(truth, 1.0);
  ASSERT_LT(truth, 2.9);
  int told = 0;
  for (double time = -0.5; time < truth - 0.05; time += 0.07) {  // it waits for half a second
    const double on_plan = std::max(time, 0.0);
    const TargetReport& report = judge(planned_slide(on_plan), plan);
    ASSERT_FALSE(report.forecast.empty());
    EXPECT_EQ(report.forecast.front().begin, 0.0);
    EXPECT_NEAR(report.forecast.back().end, std::min(PlanForecast::horizon, plan_length - on_plan),
                forecast_tolerance);
    const std::optional<double> until = seconds_until_hidden(report);
    if (truth - on_plan > PlanForecast::horizon + forecast_tolerance) {
      EXPECT_FALSE(until);
    } else if (truth - on_plan < PlanForecast::horizon - forecast_tolerance) {
      ASSERT_TRUE(until) << on_plan;
      EXPECT_NEAR(*until, truth - on_plan, forecast_tolerance);
      EXPECT_EQ(report.forecast.back().by, "slab");
      ++told;
    }
  }
  EXPECT_GT(told, 5);
}

TEST_F(PlanForecasts, EndWithThePlan) {
  const auto plan = plan_from(0.0);
  for (double time = 0.0; time < plan_length; time += 0.3) (void)judge(planned_slide(time), plan);
  EXPECT_TRUE(judge(near_slide, plan).forecast.empty());
  EXPECT_TRUE(judge(far_slide, plan).forecast.empty());
  EXPECT_FALSE(judge(far_slide, plan_from(0.0)).forecast.empty());
  EXPECT_TRUE(judge(far_slide, nullptr).forecast.empty());
}

TEST_F(PlanForecasts, TellThatATargetWillBeLost) {
  const auto lost_in = [&](double timeout) {
    Session own(slab_robot(), slab_camera(), plain_config());
    depth = scene_depth(slab_camera(), planned_slide(1.5));
    const Vector3d middle = slab_camera().intrinsics.ray(92, 57) * expected_depth;
    Frame frame = frame_of(depth, planned_slide(1.5),
                           {{.name = "ball",
                             .shape = PointTarget{middle, 0.02, ReferenceFrame::root()},
                             .handling = PointTrackerConfig{.timeout = timeout}}});
    frame.stamp = 1000 * ms;
    frame.plan = plan_from(1.5);
    return own.process(frame).targets[0].handled->lost_in;
  };
  const auto soon = lost_in(0.2), later = lost_in(0.5);
  ASSERT_TRUE(soon && later);
  EXPECT_NEAR(*later - *soon, 0.3, forecast_tolerance);
  EXPECT_FALSE(lost_in(5.0));
}

TEST_F(PlanForecasts, FollowATargetWhileThePlanWaits) {
  const auto plan = plan_from(1.5);
  EXPECT_TRUE(seconds_until_hidden(judge(planned_slide(1.5), plan, 1000 * ms)));
  EXPECT_FALSE(seconds_until_hidden(judge(planned_slide(1.5), plan, 1600 * ms, {2, 2, 6, 6})))
      << "it was moved away";
}

TEST_F(PlanForecasts, AreUnknownOffThePlan) {
  const auto plan = plan_from(0.0);
  const TargetReport& report = judge(far_slide + 0.2, plan);
  ASSERT_EQ(report.forecast.size(), 1U);
  EXPECT_EQ(report.forecast[0].verdict, Verdict::unknown);
  EXPECT_TRUE(holds(report.forecast[0].reason, "'slide'"));
  EXPECT_EQ(judge(far_slide, plan).forecast.front().verdict, Verdict::visible);
}

}  // namespace
}  // namespace penumbra::test
