// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <research/statistics.hpp>

namespace penumbra::research {
namespace {

constexpr double wrong_pose = 0.02;   // metres (conveyor)
constexpr double wrong_wrist = 0.10;  // metres (handover)
constexpr double percent = 100.0, millimetres = 1e3, degrees = 180.0 / M_PI;
/// A hidden fraction above which a frame counts as occluded (the paper).
constexpr double occluded_fraction = 0.05;

using Runs = std::span<const MethodOfSeed>;
using Value = std::function<std::optional<double>(Runs)>;

/// Measures a quantile of the error over the frames in which the target is hidden and a pose is
/// given.
Value hidden_error(double Sample::*error, double q, double scale) {
  return [=](Runs runs) -> std::optional<double> {
    std::vector<double> errors;
    for (const MethodOfSeed& run : runs)
      for (std::size_t i = 0; i < run.seed->frames.size(); ++i) {
        const FrameTruth& truth = run.seed->frames[i];
        const Sample& sample = run.method->samples[i];
        if (truth.counted && truth.hidden > occluded_fraction && sample.known)
          errors.push_back(scale * sample.*error);
      }
    return quantile(std::move(errors), q);
  };
}

/// Measures the number of events that fulfil a condition, per seed.
template <typename Condition>
Value events_per_seed(Condition condition) {
  return [=](Runs runs) -> std::optional<double> {
    std::size_t count = 0;
    for (const MethodOfSeed& run : runs)
      count += static_cast<std::size_t>(
          std::count_if(run.method->events.begin(), run.method->events.end(), condition));
    return static_cast<double>(count) / static_cast<double>(runs.size());
  };
}

/// Measures how many of the events that are `asked` fulfil a condition, percent.
template <typename Asked, typename Condition>
Value percent_of_events(Asked asked, Condition condition) {
  return [=](Runs runs) -> std::optional<double> {
    std::size_t all = 0, some = 0;
    for (const MethodOfSeed& run : runs)
      for (const Event& event : run.method->events)
        if (asked(event)) {
          ++all;
          some += condition(event) ? 1 : 0;
        }
    if (all == 0) return std::nullopt;
    return percent * static_cast<double>(some) / static_cast<double>(all);
  };
}

std::optional<double> seconds_without_pose(Runs runs) {
  double seconds = 0;
  for (const MethodOfSeed& run : runs)
    for (std::size_t i = 0; i < run.seed->frames.size(); ++i)
      if (run.seed->frames[i].counted && !run.method->samples[i].known)
        seconds += run.seed->frame_seconds;
  return seconds / static_cast<double>(runs.size());
}

/// Measures how many of the runs with a goal reached it, percent.
std::optional<double> successes(Runs runs) {
  std::size_t all = 0, good = 0;
  for (const MethodOfSeed& run : runs) {
    all += run.method->success ? 1 : 0;
    good += run.method->success.value_or(false) ? 1 : 0;
  }
  if (all == 0) return std::nullopt;
  return percent * static_cast<double>(good) / static_cast<double>(all);
}

auto accepted_wrong(double distance) {
  return [=](const Event& event) { return event.accepted && event.translation_error > distance; };
}

bool refused(const Event& event) { return !event.accepted; }

std::vector<Measure> conveyor_measures() {
  return {{"translation_median_mm", hidden_error(&Sample::translation_error, 0.5, millimetres)},
          {"translation_p95_mm", hidden_error(&Sample::translation_error, 0.95, millimetres)},
          {"rotation_median_deg", hidden_error(&Sample::rotation_error, 0.5, degrees)},
          {"rotation_p95_deg", hidden_error(&Sample::rotation_error, 0.95, degrees)},
          {"wrong_accepted", events_per_seed(accepted_wrong(wrong_pose))},
          {"wrong_accepted_hidden", events_per_seed([](const Event& event) {
             return !event.seen && accepted_wrong(wrong_pose)(event);
           })},
          {"without_pose_s", seconds_without_pose},
          {"success_percent", successes}};
}

std::vector<Measure> handover_measures() {
  return {{"translation_median_mm", hidden_error(&Sample::translation_error, 0.5, millimetres)},
          {"translation_p95_mm", hidden_error(&Sample::translation_error, 0.95, millimetres)},
          {"on_robot_accepted",
           events_per_seed([](const Event& event) { return event.accepted && event.on_robot; })},
          {"wrong_accepted", events_per_seed(accepted_wrong(wrong_wrist))},
          {"refused_visible_percent",
           percent_of_events([](const Event& event) { return event.seen; }, refused)},
          {"refused_before_robot_percent",
           percent_of_events([](const Event& event) { return event.before_robot; }, refused)},
          {"without_pose_s", seconds_without_pose},
          {"success_percent", successes}};
}

std::optional<Confidence> bootstrap(const Measure& measure, Runs seeds) {
  constexpr int resamples = 1000;
  std::mt19937_64 random(1);
  std::vector<double> values;
  std::vector<MethodOfSeed> drawn(seeds.size());
  for (int i = 0; i < resamples; ++i) {
    for (MethodOfSeed& one : drawn) one = seeds[random() % seeds.size()];
    if (const auto value = measure.value(drawn)) values.push_back(*value);
  }
  const auto low = quantile(values, 0.025), high = quantile(values, 0.975);
  if (!low || *low == *high) return std::nullopt;
  return Confidence{*low, *high};
}

}  // namespace

std::vector<Measure> measures_of(const std::string& experiment) {
  return experiment == "conveyor" ? conveyor_measures() : handover_measures();
}

std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), values.begin() + below, values.end());
  const double low = values[static_cast<std::size_t>(below)];
  if (below + 1 == static_cast<std::ptrdiff_t>(values.size())) return low;
  const double high = *std::min_element(values.begin() + below + 1, values.end());
  return low + (place - static_cast<double>(below)) * (high - low);
}

Interval interval_of(const Measure& measure, std::span<const MethodOfSeed> seeds) {
  Interval interval;
  interval.value = measure.value(seeds);
  if (interval.value && seeds.size() > 1) interval.confidence = bootstrap(measure, seeds);
  return interval;
}

std::vector<MethodOfSeed> method_of(const ExperimentResult& result, std::size_t lane,
                                    std::size_t method) {
  std::vector<MethodOfSeed> runs;
  for (const SeedRun& seed : result.seeds)
    runs.push_back({&seed, &seed.lanes[lane].methods[method]});
  return runs;
}

}  // namespace penumbra::research
