// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/planning/look_ahead.hpp>
#include <penumbra/planning/plan_forecast.hpp>

namespace penumbra {
namespace {

/// What lies within `from` to `until`, in seconds from then.
Forecast cut(const Forecast& intervals, double from, double until) {
  Forecast cut;
  for (VerdictInterval each : intervals) {
    const double length = each.end - each.begin;
    each.begin = std::max(each.begin, from) - from;
    each.end = std::min(each.end, until) - from;
    if (!(each.begin < each.end)) continue;
    if (length > 0.0) each.seen *= (each.end - each.begin) / length;
    cut.push_back(std::move(each));
  }
  return cut;
}

}  // namespace

struct PlanForecast::State {
  State(const Robot& of, const Camera& images, const PipelineConfig& config)
      : robot(of),
        camera{.name = "camera", .camera = images, .rule = config.rule},
        positions(robot.variables().size()) {}

  [[nodiscard]] std::string follow(const Frame& frame);
  [[nodiscard]] std::string look(const Frame& frame);

  Robot robot;
  ForecastCamera camera;
  std::shared_ptr<const Trajectory> given;  // the plan
  std::optional<Trajectory> plan;           // with the other joints where they are now
  double now = 0.0;                         // on the plan, seconds
  bool has_ended = false;
  std::optional<LookAhead> ahead;  // made with the first plan
  std::optional<double> looked_at;
  std::optional<std::int64_t> looked_stamp;
  std::vector<TargetForecast> forecasts;  // from then on, in seconds of the plan
  std::vector<Forecast> of_targets;       // of the frame's
  std::vector<double> positions;
};

PlanForecast::PlanForecast(const Robot& robot, const Camera& camera, const PipelineConfig& config)
    : state_(std::make_unique<State>(robot, camera, config)) {}
PlanForecast::~PlanForecast() = default;
PlanForecast::PlanForecast(PlanForecast&&) noexcept = default;
PlanForecast& PlanForecast::operator=(PlanForecast&&) noexcept = default;

std::span<const Forecast> PlanForecast::of(const Frame& frame) {
  State& s = *state_;
  if (frame.plan != s.given) {
    s.given = frame.plan;
    s.now = 0.0;
    s.has_ended = false;
    s.looked_at.reset();
  }
  s.of_targets.clear();
  if (!s.given || s.has_ended || frame.targets.empty()) return {};
  std::string reason = s.follow(frame);
  if (s.has_ended) return {};
  if (reason.empty()) reason = s.look(frame);
  const double until = std::min(s.now + horizon, s.given->duration());
  for (const Target& target : frame.targets) {
    Forecast& forecast = s.of_targets.emplace_back();
    const auto found = std::ranges::find(s.forecasts, target.name, &TargetForecast::name);
    if (!reason.empty())
      forecast = {{.end = until - s.now, .verdict = Verdict::unknown, .by = {}, .reason = reason}};
    else if (found != s.forecasts.end())
      forecast = cut(found->any.intervals, s.now, until);
  }
  return s.of_targets;
}

/// Finds where on the plan the robot is, not before where it was. Returns why it is nowhere.
std::string PlanForecast::State::follow(const Frame& frame) {
  const std::vector<double>& joints = frame.pose.positions;
  if (frame.pose.status != FrameStatus::ok || joints.size() != positions.size())
    return "the robot's joint positions are not known";
  plan = *given;
  plan->set_others(joints);
  constexpr double step = 0.01, most = 1.0;  // seconds: the latter is more than between frames
  double nearest = std::numeric_limits<double>::infinity(), at = now;
  std::size_t joint = 0;
  for (double time = now; time <= std::min(now + most, plan->duration()) + 0.5 * step;
       time += step) {
    plan->at(time, positions);
    double farthest = 0.0;
    std::size_t of = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (const double by = std::abs(positions[i] - joints[i]); by > farthest)
        farthest = by, of = i;
    if (farthest < nearest) nearest = farthest, at = time, joint = of;
  }
  if (nearest > on_plan) {
    std::ostringstream line;
    line << "the robot is not on the planned motion: joint '" << robot.variables()[joint]
         << "' is off by " << nearest;
    return line.str();
  }
  now = std::min(at, plan->duration());
  has_ended = now + step > plan->duration();
  return {};
}

/// Looks ahead anew where the last forecast does not reach far enough. Returns why it cannot.
std::string PlanForecast::State::look(const Frame& frame) {
  const auto has_forecast = [&](const Target& target) {
    return std::ranges::find(forecasts, target.name, &TargetForecast::name) != forecasts.end();
  };
  // Also while the plan waits, targets may move.
  const bool is_recent =
      looked_at && frame.stamp && looked_stamp && now < *looked_at + refresh &&
      1e-9 * static_cast<double>(stamp_distance(*looked_stamp, *frame.stamp)) < refresh;
  if (is_recent && std::ranges::all_of(frame.targets, has_forecast)) return {};
  std::vector<ForecastTarget> targets;
  for (const Target& target : frame.targets) targets.push_back({.target = target});
  looked_at.reset();
  try {
    if (ahead)
      ahead->set(targets, frame.pose);
    else
      ahead.emplace(robot, std::vector{camera}, targets, frame.pose,
                    LookAheadConfig{.step = 0.05, .clearance = 0});
    forecasts = ahead->along(*plan, now, std::min(now + horizon + refresh, plan->duration()));
  } catch (const InputError& error) {
    return error.what();
  }
  looked_at = now;
  looked_stamp = frame.stamp;
  return {};
}

}  // namespace penumbra
