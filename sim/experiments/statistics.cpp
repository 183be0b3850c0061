// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <sim/experiments/statistics.hpp>
#include <sim/experiments/units-inl.hpp>

namespace penumbra::sim {
namespace {

constexpr double wrong_pose = 0.02;   // metres (conveyor)
constexpr double wrong_wrist = 0.10;  // metres (handover)
constexpr double percent = 100.0;

using Runs = std::span<const Watched>;
using Value = std::function<std::optional<double>(Runs)>;

/// A quantile of the error over the frames in which the target is hidden and a pose is claimed.
Value hidden_error(double Sample::*error, double q, double scale) {
  return [=](Runs runs) -> std::optional<double> {
    std::vector<double> errors;
    for (const Watched& run : runs)
      for (std::size_t i = 0; i < run.seed->frames.size(); ++i) {
        const FrameTruth& truth = run.seed->frames[i];
        const Sample& sample = run.method->samples[i];
        if (truth.counted && truth.hidden > occluded_share && sample.known())
          errors.push_back(scale * sample.*error);
      }
    return quantile(std::move(errors), q);
  };
}

/// Events that fulfil something, per seed.
template <typename Condition>
Value events_per_seed(Condition condition) {
  return [=](Runs runs) -> std::optional<double> {
    std::size_t count = 0;
    for (const Watched& run : runs)
      count += static_cast<std::size_t>(
          std::count_if(run.method->events.begin(), run.method->events.end(), condition));
    return static_cast<double>(count) / static_cast<double>(runs.size());
  };
}

/// Of the events that are `asked`, the share that fulfils something, percent.
template <typename Asked, typename Condition>
Value share_of_events(Asked asked, Condition condition) {
  return [=](Runs runs) -> std::optional<double> {
    std::size_t all = 0, some = 0;
    for (const Watched& run : runs)
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
  for (const Watched& run : runs)
    for (std::size_t i = 0; i < run.seed->frames.size(); ++i)
      if (run.seed->frames[i].counted && !run.method->samples[i].known())
        seconds += run.seed->frame_seconds;
  return seconds / static_cast<double>(runs.size());
}

/// Of the runs that came to their goal.
std::optional<double> successes(Runs runs) {
  std::size_t all = 0, good = 0;
  for (const Watched& run : runs) {
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
  return {{"translation_median_mm", "Position error while hidden, median", "mm", 1,
           hidden_error(&Sample::translation_error, 0.5, millimetres)},
          {"translation_p95_mm", "Position error while hidden, p95", "mm", 1,
           hidden_error(&Sample::translation_error, 0.95, millimetres)},
          {"rotation_median_deg", "Rotation error while hidden, median", "deg", 2,
           hidden_error(&Sample::rotation_error, 0.5, degrees)},
          {"rotation_p95_deg", "Rotation error while hidden, p95", "deg", 2,
           hidden_error(&Sample::rotation_error, 0.95, degrees)},
          {"wrong_accepted", "Poses off by > 2 cm accepted, per run", "", 2,
           events_per_seed(accepted_wrong(wrong_pose)), Spread::count},
          {"wrong_accepted_hidden", "Of these, while the robot hid part", "", 2,
           events_per_seed(
               [](const Event& event) { return !event.seen && accepted_wrong(wrong_pose)(event); }),
           Spread::count},
          {"without_pose_s", "Time without a pose, per run", "s", 2, seconds_without_pose},
          {"success_percent", "Pick within 1 cm and 5 degrees", "%", 0, successes, Spread::seeds}};
}

std::vector<Measure> handover_measures() {
  return {{"translation_median_mm", "Wrist error while hidden, median", "mm", 1,
           hidden_error(&Sample::translation_error, 0.5, millimetres)},
          {"translation_p95_mm", "Wrist error while hidden, p95", "mm", 1,
           hidden_error(&Sample::translation_error, 0.95, millimetres)},
          {"on_robot_accepted", "Positions on the robot's body accepted, per run", "", 2,
           events_per_seed([](const Event& event) { return event.accepted && event.on_robot; }),
           Spread::count},
          {"wrong_accepted", "Positions off by > 10 cm accepted, per run", "", 2,
           events_per_seed(accepted_wrong(wrong_wrist)), Spread::count},
          {"refused_visible_percent", "Refused although visible", "%", 1,
           share_of_events([](const Event& event) { return event.seen; }, refused), Spread::events},
          {"refused_before_robot_percent", "Refused although visible, hand before the arm", "%", 1,
           share_of_events([](const Event& event) { return event.before_robot; }, refused),
           Spread::events},
          {"without_pose_s", "Time without a position, per run", "s", 2, seconds_without_pose},
          {"success_percent", "Hand reached within 5 cm", "%", 0, successes, Spread::seeds}};
}

std::optional<Confidence> bootstrap(const Measure& measure, Runs seeds) {
  constexpr int resamples = 1000;
  std::mt19937_64 random(1);
  std::vector<double> values;
  std::vector<Watched> drawn(seeds.size());
  for (int i = 0; i < resamples; ++i) {
    for (Watched& one : drawn) one = seeds[random() % seeds.size()];
    if (const auto value = measure.value(drawn)) values.push_back(*value);
  }
  const auto low = quantile(values, 0.025), high = quantile(values, 0.975);
  if (!low || *low == *high) return std::nullopt;
  return Confidence{*low, *high};
}

/// Of a value that is a percentage of seeds.
Confidence percent_confidence(double value, std::size_t seeds) {
  const auto count = std::llround(value / percent * static_cast<double>(seeds));
  const Confidence share = share_confidence(static_cast<std::size_t>(count), seeds);
  return {percent * share.low, percent * share.high};
}

std::optional<Confidence> confidence_of(const Measure& measure, Runs seeds, double value) {
  constexpr double few = 10;
  const auto n = static_cast<double>(seeds.size());
  const auto with_value =
      static_cast<std::size_t>(std::count_if(seeds.begin(), seeds.end(), [&](const Watched& run) {
        return measure.value(std::span(&run, 1)).has_value();
      }));
  const bool all_alike = value == 0 || value == percent;
  if (measure.spread == Spread::count && value * n < few - 0.5) {
    const Confidence count = count_confidence(static_cast<std::size_t>(std::llround(value * n)));
    return Confidence{count.low / n, count.high / n};
  }
  if (measure.spread == Spread::seeds || (measure.spread == Spread::events && all_alike))
    return percent_confidence(value, with_value);
  return bootstrap(measure, seeds);
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

Interval interval_of(const Measure& measure, std::span<const Watched> seeds) {
  Interval interval;
  interval.value = measure.value(seeds);
  if (interval.value && seeds.size() > 1)
    interval.confidence = confidence_of(measure, seeds, *interval.value);
  return interval;
}

std::vector<Watched> watched(const ExperimentResult& result, std::size_t lane, std::size_t method) {
  std::vector<Watched> runs;
  for (const SeedRun& seed : result.seeds)
    runs.push_back({&seed, &seed.lanes[lane].methods[method]});
  return runs;
}

}  // namespace penumbra::sim
