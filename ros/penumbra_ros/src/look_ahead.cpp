// SPDX-License-Identifier: Apache-2.0
#include "look_ahead.hpp"

#include <utility>

#include <penumbra_msgs/msg/target.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/planning/look_ahead.hpp>

namespace penumbra_ros {
namespace {

using penumbra::Trajectory;
using penumbra_msgs::msg::Target;

constexpr std::chrono::seconds longest_ago{2};  // older targets may have moved

/// Throws InputError that names the trajectory.
Trajectory trajectory_of(const trajectory_msgs::msg::JointTrajectory& message, std::size_t number,
                         const penumbra::Robot& robot, const std::vector<double>& positions) {
  std::vector<penumbra::TrajectoryPoint> points;
  for (const auto& point : message.points)
    points.push_back({rclcpp::Duration(point.time_from_start).seconds(), point.positions,
                      point.velocities, point.accelerations});
  try {
    return Trajectory(robot, message.joint_names, std::move(points), positions);
  } catch (const penumbra::InputError& error) {
    throw penumbra::InputError("trajectories[" + std::to_string(number) + "]: " + error.what());
  }
}

std::uint8_t to_message(penumbra::Verdict verdict) {
  switch (verdict) {
    case penumbra::Verdict::visible:
      return Target::VISIBLE;
    case penumbra::Verdict::partial:
      return Target::PARTIAL;
    case penumbra::Verdict::hidden:
      return Target::HIDDEN;
    case penumbra::Verdict::out_of_view:
      return Target::OUT_OF_VIEW;
    case penumbra::Verdict::held:
      return Target::HELD_BY_LINK;
    case penumbra::Verdict::unknown:
      break;
  }
  return Target::UNKNOWN;
}

penumbra_msgs::msg::TargetForecast to_message(const penumbra::TargetForecast& forecast) {
  penumbra_msgs::msg::TargetForecast message;
  message.name = forecast.name;
  for (const penumbra::VerdictInterval& each : forecast.any.intervals) {
    auto& interval = message.intervals.emplace_back();
    interval.begin = each.begin;
    interval.end = each.end;
    interval.verdict = to_message(each.verdict);
    interval.verdict_name = to_string(each.verdict);
    interval.by = each.by;
    interval.reason = each.reason;
  }
  return message;
}

}  // namespace

LookAheadService::LookAheadService(rclcpp_lifecycle::LifecycleNode& node, const std::string& name)
    : service_(node.create_service<Service>(
          name, [this](const std::shared_ptr<rmw_request_id_t> id,
                       const std::shared_ptr<Service::Request> request) {
            answering_ =
                std::async(std::launch::async,
                           [this, id, request,
                            former = std::make_shared<std::future<void>>(std::move(answering_))] {
                             if (former->valid()) former->wait();
                             *former = {};  // otherwise each request keeps all before it
                             Seen seen;
                             {
                               const std::lock_guard lock(mutex_);
                               seen = newest_;
                             }
                             Service::Response response = answer(*request, seen);
                             service_->send_response(*id, response);
                           });
          })) {}

void LookAheadService::take(const penumbra::io::AssembledFrame& job) {
  const std::lock_guard lock(mutex_);
  newest_.positions = job.pose.positions;
  if (job.targets.empty() && newest_.setup == job.setup) return;
  newest_.setup = job.setup;
  newest_.pose = job.pose;
  newest_.targets = job.targets;
  newest_.at = std::chrono::steady_clock::now();
}

void LookAheadService::set_rule(const penumbra::LabelRule& rule) {
  const std::lock_guard lock(mutex_);
  newest_.rule = rule;
}

LookAheadService::Service::Response LookAheadService::answer(const Service::Request& request,
                                                             const Seen& seen) {
  Service::Response response;
  try {
    if (!seen.setup) throw penumbra::InputError("no image is judged yet");
    if (seen.targets.empty() || std::chrono::steady_clock::now() - seen.at > longest_ago)
      throw penumbra::InputError("no targets came in the last 2 seconds");
    if (request.trajectories.empty()) throw penumbra::InputError("no trajectories");
    const penumbra::Robot& robot = seen.setup->posed->robot;
    if (!penumbra::has_pose(seen.pose.status) ||
        seen.positions.size() != robot.variables().size() ||
        seen.pose.positions.size() != robot.variables().size())
      throw penumbra::InputError("the robot's joint positions are not known");
    const penumbra::ForecastCamera camera{
        .name = "camera", .camera = seen.setup->cameras()->judged, .rule = seen.rule};
    std::vector<penumbra::ForecastTarget> targets;
    for (const penumbra::Target& target : seen.targets) targets.push_back({.target = target});
    penumbra::LookAhead ahead(robot, {camera}, targets, seen.pose, {.clearance = 0});
    std::vector<std::vector<penumbra::TargetForecast>> forecasts;
    for (const auto& message : request.trajectories) {
      const Trajectory motion = trajectory_of(message, forecasts.size(), robot, seen.positions);
      for (const std::string& note : motion.notes())
        response.message += (response.message.empty() ? "trajectories[" : "\ntrajectories[") +
                            std::to_string(forecasts.size()) + "]: " + note;
      forecasts.push_back(ahead.along(motion));
    }
    response.forecasts.resize(forecasts.size());
    for (const penumbra::RankedMotion& motion : penumbra::rank(forecasts)) {
      response.order.push_back(static_cast<std::uint32_t>(motion.trajectory));
      auto& forecast = response.forecasts[motion.trajectory];
      forecast.seen = motion.seen;
      forecast.reason = motion.reason;
      for (const penumbra::TargetForecast& target : forecasts[motion.trajectory])
        forecast.targets.push_back(to_message(target));
    }
    response.success = true;
  } catch (const std::exception& error) {
    response = Service::Response();
    response.message = error.what();
  }
  return response;
}

}  // namespace penumbra_ros
