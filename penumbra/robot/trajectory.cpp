// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/robot/trajectory.hpp>

namespace penumbra {
namespace {

void check_values(const TrajectoryPoint& point, std::size_t index, std::size_t variables) {
  const auto fault = [&](const std::string& what) {
    throw InputError("point " + std::to_string(index) + " of the trajectory: " + what);
  };
  const auto check = [&](const char* name, const std::vector<double>& values, bool may_be_empty) {
    if (may_be_empty && values.empty()) return;
    if (values.size() != variables)
      fault(std::to_string(values.size()) + " " + name + " for " + std::to_string(variables) +
            " joints");
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
      fault(std::string(name) + " that are not finite");
  };
  if (!(point.time >= 0.0 && point.time <= Trajectory::max_duration))
    fault("time " + std::to_string(point.time) +
          "; expected 0 to 3600 seconds from the start of the motion");
  check("positions", point.positions, false);
  check("velocities", point.velocities, true);
  check("accelerations", point.accelerations, true);
  if (point.velocities.empty() && !point.accelerations.empty())
    fault("accelerations without velocities");
}

/// A value on the way from a to b, which are `duration` seconds apart, `time` after a: the
/// polynomial of least degree that has both positions and, if given, velocities and accelerations.
double interpolate(const TrajectoryPoint& a, const TrajectoryPoint& b, std::size_t i,
                   double duration, double time) {
  const double t = time / duration;
  const double way = b.positions[i] - a.positions[i];
  if (a.velocities.empty() || b.velocities.empty()) return a.positions[i] + t * way;
  const double va = a.velocities[i] * duration, vb = b.velocities[i] * duration;
  if (a.accelerations.empty() || b.accelerations.empty())
    return a.positions[i] + t * (va + t * (3.0 * way - 2.0 * va - vb + t * (va + vb - 2.0 * way)));
  const double half_a = 0.5 * a.accelerations[i] * duration * duration;
  const double half_b = 0.5 * b.accelerations[i] * duration * duration;
  const double c3 = 10.0 * way - 6.0 * va - 4.0 * vb - 3.0 * half_a + half_b;
  const double c4 = -15.0 * way + 8.0 * va + 7.0 * vb + 3.0 * half_a - 2.0 * half_b;
  const double c5 = 6.0 * way - 3.0 * va - 3.0 * vb - half_a + half_b;
  return a.positions[i] + t * (va + t * (half_a + t * (c3 + t * (c4 + t * c5))));
}

}  // namespace

Trajectory::Trajectory(const Robot& robot, std::span<const std::string> variables,
                       std::vector<TrajectoryPoint> points, std::span<const double> start)
    : points_(std::move(points)), start_(start.begin(), start.end()) {
  if (start.size() != robot.variables().size())
    throw std::invalid_argument("a trajectory's start has " + std::to_string(start.size()) +
                                " values; the robot has " +
                                std::to_string(robot.variables().size()) + " variables");
  for (const std::string& name : variables) {
    const auto variable = robot.find_variable(name);
    if (!variable && std::ranges::any_of(robot.joints(), [&](const Joint& joint) {
          return joint.mimics && joint.name == name;
        })) {
      variables_.emplace_back();
      continue;
    }
    if (!variable)
      throw InputError("the trajectory moves joint '" + name + "', which robot '" + robot.name() +
                       "' does not have");
    if (std::ranges::find(variables_, *variable) != variables_.end())
      throw InputError("the trajectory names joint '" + name + "' twice");
    variables_.push_back(*variable);
  }
  if (points_.empty()) throw InputError("the trajectory has no points");
  for (std::size_t i = 0; i < points_.size(); ++i) {
    check_values(points_[i], i, variables_.size());
    if (i > 0 && !(points_[i].time > points_[i - 1].time))
      throw InputError("point " + std::to_string(i) + " of the trajectory: time " +
                       std::to_string(points_[i].time) + " s does not rise from " +
                       std::to_string(points_[i - 1].time) + " s");
  }
  TrajectoryPoint first{.positions = std::vector<double>(variables_.size()),
                        .velocities = std::vector<double>(variables_.size()),
                        .accelerations = std::vector<double>(variables_.size())};
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (variables_[i]) first.positions[i] = start_[*variables_[i]];
  if (points_.front().time > 0.0) {
    points_.insert(points_.begin(), std::move(first));
    return;
  }
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const double by = std::abs(points_.front().positions[i] - first.positions[i]);
    if (variables_[i] && by > jump_.by) jump_ = {*variables_[i], by};
  }
}

void Trajectory::set_others(std::span<const double> positions) {
  std::ranges::copy(positions, start_.begin());
}

void Trajectory::at(double time, std::span<double> positions) const {
  std::ranges::copy(start_, positions.begin());
  const double within = std::clamp(time, points_.front().time, points_.back().time);
  const auto after =
      std::ranges::upper_bound(points_, within, std::ranges::less{}, &TrajectoryPoint::time);
  for (std::size_t i = 0; i < variables_.size(); ++i)
    if (variables_[i])
      positions[*variables_[i]] =
          after == points_.end()
              ? points_.back().positions[i]
              : interpolate(*(after - 1), *after, i, after->time - (after - 1)->time,
                            within - (after - 1)->time);
}

std::vector<std::string> Trajectory::beyond_limits(const Robot& robot) const {
  std::vector<std::string> lines;
  for (const Joint& joint : robot.joints()) {
    if (!joint.variable || joint.mimics) continue;
    const auto moved = std::ranges::find(variables_, joint.variable);
    if (moved == variables_.end()) continue;
    const auto i = static_cast<std::size_t>(moved - variables_.begin());
    double most = 0.0, at = 0.0;
    for (const TrajectoryPoint& point : points_) {
      const double value = point.positions[i];
      const double excess =
          std::max(joint.lower.value_or(value) - value, value - joint.upper.value_or(value));
      if (excess > most) most = excess, at = point.time;
    }
    constexpr double rounding = 1e-6;
    if (most < rounding) continue;
    std::ostringstream line;
    line << "joint '" << joint.name << "' exceeds its limit by " << most
         << (joint.type == JointType::prismatic ? " m" : " rad") << " at " << at << " s";
    lines.push_back(line.str());
  }
  return lines;
}

}  // namespace penumbra
