// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
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
    for (const double value : values)
      if (!(std::abs(value) <= Robot::max_position))
        fault(std::string(name) + " with " + detail::printed(value) +
              "; expected rad and m, to +-1e9");
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

void check_points(std::span<const TrajectoryPoint> points, std::size_t variables) {
  if (points.empty()) throw InputError("the trajectory has no points");
  for (std::size_t i = 0; i < points.size(); ++i) {
    check_values(points[i], i, variables);
    if (i > 0 && !(points[i].time > points[i - 1].time))
      throw InputError("point " + std::to_string(i) + " of the trajectory: time " +
                       std::to_string(points[i].time) + " s does not rise from " +
                       std::to_string(points[i - 1].time) + " s");
  }
}

/// Compares the ways between points with what their velocities make of them.
void check_velocities(std::span<const TrajectoryPoint> points) {
  constexpr double most = 20.0;    // times as far; milliseconds make it 1000, degrees 57
  constexpr double little = 10.0;  // rad or m in all: noise of a robot at rest
  double way = 0.0, by_velocity = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const TrajectoryPoint &a = points[k - 1], &b = points[k];
    if (a.velocities.empty() || b.velocities.empty()) continue;
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
      way += std::abs(b.positions[i] - a.positions[i]);
      by_velocity += 0.5 * std::abs(a.velocities[i] + b.velocities[i]) * (b.time - a.time);
    }
  }
  if (by_velocity > most * way + little)
    throw InputError("the trajectory's velocities and times move the joints by " +
                     detail::printed(by_velocity) + " rad and m in all, its positions by " +
                     detail::printed(way) + "; expected times in seconds, and rad/s and m/s");
}

/// Velocity limit of a variable, rad/s or m/s; that of a fast robot if the URDF's is higher or
/// missing.
double usual_speed(const Joint& joint) {
  const double fast =
      joint.type == JointType::revolute || joint.type == JointType::continuous ? 3.14 : 1.0;
  return std::min(joint.velocity.value_or(fast), fast);
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
    : robot_(robot), points_(std::move(points)), start_(start.begin(), start.end()) {
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
  check_points(points_, variables_.size());
  check_velocities(points_);
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
          std::clamp(after == points_.end()
                         ? points_.back().positions[i]
                         : interpolate(*(after - 1), *after, i, after->time - (after - 1)->time,
                                       within - (after - 1)->time),
                     -Robot::max_position, Robot::max_position);
}

Trajectory::Fastest Trajectory::fastest(std::size_t i) const {
  Fastest found;
  const auto take = [&](double speed, double time) {
    if (std::abs(speed) > found.speed) found = {std::abs(speed), time};
  };
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const TrajectoryPoint& point = points_[k];
    if (!point.velocities.empty()) take(point.velocities[i], point.time);
    if (k == 0) continue;
    const TrajectoryPoint& before = points_[k - 1];
    take((point.positions[i] - before.positions[i]) / (point.time - before.time), before.time);
  }
  return found;
}

void Trajectory::append_limits(const Joint& joint, std::size_t i,
                               std::vector<std::string>& lines) const {
  constexpr double rounding_speed = 1.05;  // times the limit: times are written with few digits
  const bool is_way = joint.type == JointType::prismatic;
  const double overshoot = is_way ? 0.001 : 0.01;  // m or rad: plans begin where arms are
  // A <limit> without lower and upper has 0 for both by the format, and means no range.
  const bool has_range = joint.lower != joint.upper;
  const auto add = [&](const char* limit, double excess, const char* unit, double at) {
    std::ostringstream line;
    line << "joint '" << joint.name << "' exceeds its " << limit << " by " << excess << unit
         << " at " << at << " s";
    lines.push_back(line.str());
  };
  double most = 0.0, at = 0.0;
  for (const TrajectoryPoint& point : points_) {
    const double value = point.positions[i];
    const double excess =
        std::max(joint.lower.value_or(value) - value, value - joint.upper.value_or(value));
    if (excess > most) most = excess, at = point.time;
  }
  if (has_range && most >= overshoot) add("limit", most, is_way ? " m" : " rad", at);
  const Fastest fast = fastest(i);
  if (joint.velocity && fast.speed > rounding_speed * *joint.velocity)
    add("velocity limit", fast.speed - *joint.velocity, is_way ? " m/s" : " rad/s", fast.at);
}

/// A robot that moves takes more than a thousandth of its joints' speed.
std::string Trajectory::slow_line() const {
  constexpr double least_duration = 60.0, least_way = 0.01;  // seconds; rad or m of a joint
  constexpr double slow = 1.5e-3;                            // of a joint's usual speed
  if (duration() < least_duration) return {};
  double farthest = 0.0;
  for (const Joint& joint : robot_.joints()) {
    const auto moved = std::ranges::find(variables_, joint.variable);
    if (!joint.variable || joint.mimics || moved == variables_.end()) continue;
    const auto i = static_cast<std::size_t>(moved - variables_.begin());
    if (fastest(i).speed > slow * usual_speed(joint)) return {};
    for (const TrajectoryPoint& point : points_)
      farthest = std::max(farthest, std::abs(point.positions[i] - points_.front().positions[i]));
  }
  if (farthest < least_way) return {};
  std::ostringstream line;
  line << "the motion takes " << duration()
       << " s, and no joint moves faster than a thousandth of its limit: are times in "
          "milliseconds? give seconds";
  return line.str();
}

std::vector<std::string> Trajectory::notes() const {
  std::vector<std::string> lines;
  for (const Joint& joint : robot_.joints()) {
    const auto moved = std::ranges::find(variables_, joint.variable);
    if (joint.variable && !joint.mimics && moved != variables_.end())
      append_limits(joint, static_cast<std::size_t>(moved - variables_.begin()), lines);
  }
  if (std::string line = slow_line(); !line.empty()) lines.push_back(std::move(line));
  return lines;
}

}  // namespace penumbra
