// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <penumbra/tuning/cloud_tuning.hpp>

namespace penumbra {
namespace {

constexpr double tolerated = 3.5;  // deviations of tolerance: 0.05 % of normal noise is beyond
constexpr std::size_t least_points = 1000;  // on the robot
constexpr std::size_t least_in_ring = 200;  // around its outline
constexpr double largest_bias = 0.02;       // metres; more is a wrong pose
constexpr double largest_deviation = 0.05;  // metres, likewise
constexpr double usual_share = 0.02;        // by which rings differ
constexpr double largest_share = 0.3;       // of them if the robot stands free
constexpr double wide = 0.15;               // metres, several deviations of any sensor
constexpr double millimetre = 1e-3;

double share_of(std::size_t some, std::size_t of) {
  return static_cast<double>(some) / static_cast<double>(std::max<std::size_t>(of, 1));
}

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

}  // namespace

/// 1 mm to 0.19 m.
double CloudTuner::tolerance_at(std::size_t step) {
  return millimetre * std::pow(1.3, static_cast<double>(step));
}

bool CloudTuner::add(Pipeline& pipeline, const Frame& frame) {
  const auto report_by = [&](const CloudRule& rule) -> const FrameReport& {
    pipeline.set_rule(rule);
    return pipeline.process(frame);
  };
  const bool has_rays = frame.scan && frame.scan->origin;
  CloudRule rule = rule_;
  rule.beam = 0.0;  // no fringe: all rays that meet the robot are front, occluded or beyond
  rule.beyond_factor = 1.0;
  for (std::size_t i = 0; i < steps; ++i) {
    rule.tolerance = {.a = tolerance_at(i), .b = 0.0, .c = 0.0};
    const FrameReport& report = report_by(rule);
    if (i == 0 && (report.status != FrameStatus::ok || !has_rays)) {
      pipeline.set_rule(rule_);
      if (refused_because_.empty())
        refused_because_ = has_rays ? report.message : "clouds without rays show no ranges";
      return false;
    }
    front_[i] += report.pixels.front;
    beyond_[i] += report.pixels.beyond;
    if (i == 0) on_robot_ += *report.pixels.robot;
  }
  rule = rule_;
  rule.tolerance = {.a = wide, .b = 0.0, .c = 0.0};  // what is on the robot is no fringe
  for (std::size_t i = 0; i < beams.size(); ++i) {
    rule.beam = beams[i];
    rule.mixing = rule_.mixing;
    mixed_[i] += report_by(rule).pixels.fringe;
    rule.mixing = CloudRule::max_mixing;
    behind_[i] += report_by(rule).pixels.fringe;
  }
  ++scans_;
  pipeline.set_rule(rule_);
  return true;
}

CloudTuning CloudTuner::result() const {
  CloudTuning out;
  out.scans = scans_;
  out.rule = rule_;
  measure_ranges(out);
  if (out.has_tolerance) measure_beam(out);
  return out;
}

/// Finds the distribution of r - s from the shares before and behind the robot by each tolerance.
/// What is farther away than the largest tolerance is something else.
void CloudTuner::measure_ranges(CloudTuning& out) const {
  out.points = on_robot_ - front_.back() - beyond_.back();
  if (out.points < least_points) {
    out.problems.push_back("only " + std::to_string(out.points) + " points are on the robot: " +
                           (scans_ > 0 || refused_because_.empty()
                                ? "bring more of it into the sensor's view"
                                : "no cloud can be measured, the first: " + refused_because_));
    return;
  }
  std::vector<std::pair<double, double>> curve;  // r - s, and the share below
  for (std::size_t i = steps; i-- > 0;)
    curve.emplace_back(-tolerance_at(i), share_of(front_[i] - front_.back(), out.points));
  for (std::size_t i = 0; i < steps; ++i)
    curve.emplace_back(tolerance_at(i), 1.0 - share_of(beyond_[i] - beyond_.back(), out.points));
  const auto quantile = [&](double share) {
    const auto after = std::find_if(curve.begin() + 1, curve.end() - 1,
                                    [&](const auto& point) { return point.second >= share; });
    const auto [x0, y0] = *(after - 1);
    const auto [x1, y1] = *after;
    return y1 > y0 ? x0 + (x1 - x0) * std::clamp((share - y0) / (y1 - y0), 0.0, 1.0) : x1;
  };
  constexpr double one_sigma = 0.1587;  // of normal noise below the mean by one deviation
  out.bias = quantile(0.5);
  out.deviation = 0.5 * (quantile(1.0 - one_sigma) - quantile(one_sigma));
  if (std::abs(out.bias) > largest_bias) {
    out.problems.push_back("the robot is measured " +
                           std::to_string(std::lround(std::abs(out.bias) / millimetre)) + " mm " +
                           (out.bias > 0 ? "behind" : "before") +
                           " its model: correct the sensor's pose first");
    return;
  }
  if (out.deviation > largest_deviation) {
    out.problems.push_back("the ranges of the robot scatter by " +
                           std::to_string(std::lround(out.deviation / millimetre)) +
                           " mm around its model, more than any sensor's: correct the sensor's "
                           "pose, the joint positions or their stamps first");
    return;
  }
  const double wanted = std::abs(out.bias) + tolerated * out.deviation;
  out.rule.tolerance = {.a = millimetre * std::ceil(wanted / millimetre), .b = 0.0, .c = 0.0};
  out.has_tolerance = true;
}

/// Finds the ring around the robot's outline from which on no more points are of its range than in
/// the median ring.
void CloudTuner::measure_beam(CloudTuning& out) const {
  std::array<double, beams.size()> shares{};
  std::size_t fewest = behind_.front();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t behind = behind_[i] - (i > 0 ? behind_[i - 1] : 0);
    fewest = std::min(fewest, behind);
    shares[i] = share_of(mixed_[i] - (i > 0 ? mixed_[i - 1] : 0), behind);
  }
  if (fewest < least_in_ring) {
    out.problems.push_back("too few points are next to the robot: the beam is not measured");
    return;
  }
  // Where mixed returns are least likely: the two outermost rings.
  const double usual = 0.5 * (shares[beams.size() - 2] + shares.back());
  if (usual > largest_share) {
    out.problems.push_back(percent(usual) +
                           " of the points next to the robot are of its range: the beam is not "
                           "measured; let it move through free space");
    return;
  }
  const double chance = 2.0 * std::sqrt(usual / static_cast<double>(fewest));
  std::size_t ring = 0;
  while (ring < beams.size() - 2 && shares[ring] > usual + usual_share + chance) ++ring;
  if (ring == beams.size() - 2) {
    out.problems.push_back(
        "points of the robot's range reach far beyond its outline: correct the sensor's pose, the "
        "joint positions or their stamps first");
    return;
  }
  out.rule.beam = beams[ring];
  out.has_beam = true;
}

}  // namespace penumbra
