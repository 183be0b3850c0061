// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/base/stamps.hpp>
#include <penumbra/session/plan_forecast.hpp>

namespace penumbra {
namespace {

/// What lies within `from` to `until`, in seconds from then.
std::vector<VerdictInterval> cut(std::span<const VerdictInterval> intervals, double from,
                                 double until) {
  std::vector<VerdictInterval> cut;
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

/// When a target will be lost that is hidden for longer than its timeout. At the end of a plan the
/// robot stays where it is.
std::optional<double> lost_in(const Target& target, const TargetReport& report) {
  const double timeout = std::visit(
      [](const auto& handling) {
        if constexpr (requires { handling.timeout; }) return handling.timeout;
        return std::numeric_limits<double>::infinity();
      },
      target.handling);
  for (const VerdictInterval& each : report.forecast) {
    if (each.verdict != Verdict::hidden) continue;
    const double lost = timeout + (each.begin > 0.0 ? each.begin : -report.handled->age);
    if (lost < each.end) return std::max(lost, 0.0);
  }
  return std::nullopt;
}

}  // namespace

PlanForecast::PlanForecast(const Robot& robot, const Camera& camera, const PipelineConfig& config)
    : robot_(robot),
      camera_{.name = "camera",
              .camera = camera,
              .parent = config.camera_parent,
              .T_parent_camera = config.T_parent_camera,
              .rule = config.rule},
      positions_(robot.variables().size()) {}

void PlanForecast::add(const Frame& frame, std::span<TargetReport> reports) {
  if (frame.plan != given_) {
    given_ = frame.plan;
    now_ = 0.0;
    has_ended_ = false;
    looked_at_.reset();
  }
  if (!given_ || has_ended_ || reports.empty()) return;
  std::string reason = follow(frame);
  if (has_ended_) return;
  if (reason.empty()) reason = look(frame);
  const double until = std::min(now_ + horizon, given_->duration());
  for (TargetReport& report : reports) {
    const auto found = std::ranges::find(forecasts_, report.name, &TargetForecast::name);
    if (!reason.empty())
      report.forecast = {
          {.end = until - now_, .verdict = Verdict::unknown, .by = {}, .reason = reason}};
    else if (found != forecasts_.end())
      report.forecast = cut(found->any.intervals, now_, until);
    const auto target = std::ranges::find(frame.targets, report.name, &Target::name);
    if (report.handled && target != frame.targets.end())
      report.handled->lost_in = lost_in(*target, report);
  }
}

/// Finds where on the plan the robot is, not before where it was. Returns why it is nowhere.
std::string PlanForecast::follow(const Frame& frame) {
  const std::vector<double>& joints = frame.pose.positions;
  if (frame.pose.status != FrameStatus::ok || joints.size() != positions_.size())
    return "the robot's joint positions are not known";
  plan_ = *given_;
  plan_->set_others(joints);
  constexpr double step = 0.01, most = 1.0;  // seconds: the latter is more than between frames
  double nearest = std::numeric_limits<double>::infinity(), at = now_;
  std::size_t joint = 0;
  for (double time = now_; time <= std::min(now_ + most, plan_->duration()) + 0.5 * step;
       time += step) {
    plan_->at(time, positions_);
    double farthest = 0.0;
    std::size_t of = 0;
    for (std::size_t i = 0; i < positions_.size(); ++i)
      if (const double by = std::abs(positions_[i] - joints[i]); by > farthest)
        farthest = by, of = i;
    if (farthest < nearest) nearest = farthest, at = time, joint = of;
  }
  if (nearest > on_plan) {
    std::ostringstream line;
    line << "the robot is not on the planned motion: joint '" << robot_.variables()[joint]
         << "' is off by " << nearest;
    return line.str();
  }
  now_ = std::min(at, plan_->duration());
  has_ended_ = now_ + step > plan_->duration();
  return {};
}

/// Looks ahead anew where the last forecast does not reach far enough. Returns why it cannot.
std::string PlanForecast::look(const Frame& frame) {
  const auto has_forecast = [&](const Target& target) {
    return std::ranges::find(forecasts_, target.name, &TargetForecast::name) != forecasts_.end();
  };
  // Also while the plan waits, targets may move.
  const bool is_recent =
      looked_at_ && frame.stamp && looked_stamp_ && now_ < *looked_at_ + refresh &&
      1e-9 * static_cast<double>(stamp_distance(*looked_stamp_, *frame.stamp)) < refresh;
  if (is_recent && std::ranges::all_of(frame.targets, has_forecast)) return {};
  std::vector<ForecastTarget> targets;
  for (const Target& target : frame.targets) targets.push_back({.target = target});
  looked_at_.reset();
  try {
    if (ahead_)
      ahead_->set(targets, frame.pose);
    else
      ahead_.emplace(robot_, std::vector{camera_}, targets, frame.pose,
                     LookAheadConfig{.step = 0.05, .clearance = 0});
    forecasts_ = ahead_->along(*plan_, now_, std::min(now_ + horizon + refresh, plan_->duration()));
  } catch (const InputError& error) {
    return error.what();
  }
  looked_at_ = now_;
  looked_stamp_ = frame.stamp;
  return {};
}

}  // namespace penumbra
