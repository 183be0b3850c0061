// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <variant>

#include <penumbra/base/error.hpp>
#include <penumbra/planning/camera_predictor-inl.hpp>
#include <penumbra/planning/look_ahead.hpp>
#include <penumbra/planning/parallel-inl.hpp>
#include <penumbra/robot/drawn_links.hpp>

namespace penumbra {
namespace {

using planning::AnchoredTarget;
using planning::CameraPredictor;
using planning::parallel_for;
using planning::Sample;

constexpr double least_step = 0.001;  // seconds
// Bound the samples of a long motion, which are kept.
constexpr double most_steps = 36'000, most_samples = 180'000;

void check(const LookAheadConfig& config) {
  const auto fault = [](const std::string& what) { throw InputError("look-ahead: " + what); };
  if (config.threads < 1 || config.threads > RendererOptions::max_threads)
    fault("threads is " + std::to_string(config.threads) + "; expected 1 to " +
          std::to_string(RendererOptions::max_threads));
  for (const auto& [name, value] :
       {std::pair("step", config.step), {"motion", config.motion}, {"border", config.border}})
    if (!(std::isfinite(value) && value >= least_step))
      fault(std::string(name) + " is " + std::to_string(value) + "; expected 0.001 or more");
  if (config.clearance < 0 || config.clearance > planning::max_clearance)
    fault("clearance is " + std::to_string(config.clearance) + " pixels; expected 0 to " +
          std::to_string(planning::max_clearance));
}

/// One camera's samples of a part of a motion.
class Sampler {
 public:
  Sampler(CameraPredictor& judge, const Trajectory& trajectory, const LookAheadConfig& config,
          double least, std::size_t variables)
      : judge_(judge),
        trajectory_(trajectory),
        config_(config),
        least_(least),
        positions_(variables) {}

  /// Returns samples at these times, which rise, and between them, as close as the motion asks.
  std::vector<Sample> at_least(std::span<const double> times) {
    Sample before = at(times.front());
    keep(before);
    for (const double time : times.subspan(1)) {
      Sample next = at(time);
      refine(before, next);
      keep(next);
      before = std::move(next);
    }
    return std::move(samples_);
  }

 private:
  Sample at(double time) {
    trajectory_.at(time, positions_);
    return judge_.at(time, positions_);
  }

  /// Without places, which only refine() compares.
  void keep(const Sample& sample) {
    samples_.push_back(
        {.time = sample.time, .predictions = sample.predictions, .targets = {}, .bodies = {}});
  }

  /// Adds what is needed between two samples.
  void refine(const Sample& a, const Sample& b) {
    const double apart = b.time - a.time;
    const bool is_wanted = apart > config_.border && differ(a, b);
    if (!is_wanted && !(apart > least_ && moves_far(a, b))) return;
    Sample middle = at(0.5 * (a.time + b.time));
    refine(a, middle);
    keep(middle);
    refine(middle, b);
  }

  static bool differ(const Sample& a, const Sample& b) {
    return !std::ranges::equal(a.predictions, b.predictions, {}, &Prediction::verdict,
                               &Prediction::verdict);
  }

  /// Whether a target, or a part of the robot next to it, moves by too much of the target's size.
  [[nodiscard]] bool moves_far(const Sample& a, const Sample& b) const {
    if (a.bodies.empty() || b.bodies.empty()) return false;
    std::vector<double> motions;
    for (std::size_t body = 0; body < a.bodies.size(); ++body)
      motions.push_back(a.bodies[body].pixels.empty() && b.bodies[body].pixels.empty()
                            ? 0.0
                            : judge_.motion_of(body, a, b));
    for (std::size_t i = 0; i < a.targets.size(); ++i) {
      const PixelRectangle &from = a.targets[i], &to = b.targets[i];
      if (from.empty() || to.empty()) continue;
      const double most = std::max(
          1.0, config_.motion * std::min({from.width(), from.height(), to.width(), to.height()}));
      if (std::max(std::abs(from.u0 + from.u1 - to.u0 - to.u1),
                   std::abs(from.v0 + from.v1 - to.v0 - to.v1)) > 2.0 * most)
        return true;
      for (std::size_t body = 0; body < motions.size(); ++body) {
        if (motions[body] <= most) continue;
        const auto by = static_cast<int>(std::min(motions[body], 1e6));
        const PixelRectangle swept = a.bodies[body].pixels.united(b.bodies[body].pixels);
        if (!overlap(grown(swept, by, by), from.united(to)).empty()) return true;
      }
    }
    return false;
  }

  CameraPredictor& judge_;
  const Trajectory& trajectory_;
  const LookAheadConfig& config_;
  double least_;  // seconds
  std::vector<double> positions_;
  std::vector<Sample> samples_;
};

/// Adds an interval, or extends the last one of the same verdict.
void add(Forecast& intervals, VerdictInterval next) {
  if (intervals.empty() || intervals.back().verdict != next.verdict) {
    intervals.push_back(std::move(next));
    return;
  }
  VerdictInterval& last = intervals.back();
  last.end = next.end;
  last.seen += next.seen;
  if (next.hidden > last.hidden || last.by.empty()) {
    last.hidden = std::max(last.hidden, next.hidden);
    last.by = std::move(next.by);
  }
}

/// The less the more of a target is seen.
int order_of(Verdict verdict) {
  constexpr std::array order = {Verdict::held,    Verdict::visible, Verdict::partial,
                                Verdict::unknown, Verdict::hidden,  Verdict::out_of_view};
  return static_cast<int>(std::ranges::find(order, verdict) - order.begin());
}

bool is_seen(Verdict verdict) { return order_of(verdict) <= order_of(Verdict::partial); }

Forecast intervals_of(const CameraForecast& forecast) {
  Forecast intervals;
  for (std::size_t i = 0; i < forecast.times.size(); ++i) {
    const Prediction& prediction = forecast.predictions[i];
    const bool is_last = i + 1 == forecast.times.size();
    const double begin =
        i == 0 ? forecast.times[i] : 0.5 * (forecast.times[i - 1] + forecast.times[i]);
    const double end =
        is_last ? forecast.times[i] : 0.5 * (forecast.times[i] + forecast.times[i + 1]);
    const double seen =
        is_seen(prediction.verdict) ? (1.0 - prediction.hidden) * (end - begin) : 0.0;
    add(intervals, {begin, end, prediction.verdict, prediction.hidden, seen, prediction.by,
                    prediction.reason});
  }
  return intervals;
}

/// What the camera that sees most sees.
Forecast together(const std::vector<CameraForecast>& cameras) {
  std::set<double> borders;
  for (const CameraForecast& camera : cameras)
    for (const VerdictInterval& each : camera.intervals) borders.insert({each.begin, each.end});
  Forecast intervals;
  std::vector<std::size_t> at(cameras.size());  // of each camera's intervals
  for (auto border = borders.begin(); border != borders.end(); ++border) {
    const auto next = std::next(border);
    if (next == borders.end() && borders.size() > 1) break;
    VerdictInterval best;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const auto& all = cameras[c].intervals;
      while (at[c] + 1 < all.size() && all[at[c]].end <= *border) ++at[c];
      const VerdictInterval& each = all[at[c]];
      if (c == 0 || std::pair(order_of(each.verdict), each.hidden) <
                        std::pair(order_of(best.verdict), best.hidden))
        best = each;
    }
    const double length = best.end - best.begin;
    best.begin = *border;
    best.end = next == borders.end() ? *border : *next;
    if (length > 0.0) best.seen *= (best.end - best.begin) / length;
    add(intervals, std::move(best));
  }
  return intervals;
}

std::string reason_of(std::span<const TargetForecast> forecasts) {
  const TargetForecast* of = nullptr;
  const VerdictInterval* worst = nullptr;
  const auto cost = [](const VerdictInterval& each) {
    constexpr double out_of_view = 1e-3;  // it is named if nothing else costs
    return (each.verdict == Verdict::out_of_view ? out_of_view : 1.0) *
           (each.end - each.begin - each.seen);
  };
  for (const TargetForecast& forecast : forecasts)
    for (const VerdictInterval& each : forecast.any.intervals)
      if (cost(each) > (worst == nullptr ? 1e-6 : cost(*worst))) of = &forecast, worst = &each;
  if (worst == nullptr) return {};
  std::ostringstream line;
  line << std::fixed << std::setprecision(2) << "'" << of->name << "' is "
       << to_string(worst->verdict);
  if (!worst->by.empty()) line << " behind '" << worst->by << "'";
  line << " from " << worst->begin << " s, for " << worst->end - worst->begin << " s";
  return line.str();
}

}  // namespace

std::optional<double> CameraForecast::hidden_at() const {
  const auto found = std::ranges::find(intervals, Verdict::hidden, &VerdictInterval::verdict);
  return found == intervals.end() ? std::nullopt : std::optional(found->begin);
}

std::optional<double> CameraForecast::seen_again_at() const {
  auto at = std::ranges::find(intervals, Verdict::hidden, &VerdictInterval::verdict);
  at = std::find_if(at, intervals.end(), [](const auto& each) { return is_seen(each.verdict); });
  return at == intervals.end() ? std::nullopt : std::optional(at->begin);
}

double CameraForecast::seen_for() const {
  double seconds = 0.0;
  for (const VerdictInterval& each : intervals) seconds += each.seen;
  return seconds;
}

struct LookAhead::State {
  /// The judge of a camera on a thread.
  CameraPredictor& judge(std::size_t camera, std::size_t thread) {
    std::unique_ptr<CameraPredictor>& made =
        judges[camera * static_cast<std::size_t>(config.threads) + thread];
    if (made == nullptr)
      made = std::make_unique<CameraPredictor>(robot, cameras[camera], targets, start_of(camera),
                                               config.clearance);
    return *made;
  }

  /// The start, with the first camera's pose only.
  [[nodiscard]] RobotPose start_of(std::size_t camera) const {
    RobotPose of = start;
    if (camera > 0) of.T_parent_camera.reset();
    return of;
  }

  void set(const std::vector<ForecastTarget>& given, RobotPose at) {
    start = std::move(at);
    const ForecastCamera& first = cameras.front();
    std::vector<Eigen::Isometry3d> T_root_link(robot.links().size());
    robot.forward_kinematics(start.positions, T_root_link);
    const Eigen::Isometry3d T_root_camera =
        T_root_link[find_camera_parent(robot, first.camera.parent)] *
        start.T_parent_camera.value_or(first.camera.pose());
    targets.clear();
    for (const ForecastTarget& target : given)
      targets.push_back(planning::anchored(target, first.camera, T_root_camera));
    for (std::size_t i = 0; i < judges.size(); ++i)
      if (judges[i] &&
          !judges[i]->set(targets, start_of(i / static_cast<std::size_t>(config.threads))))
        judges[i].reset();
    check_modal_targets();
  }

  /// A detector's box of what it sees is the whole target only where the robot cuts nothing off.
  void check_modal_targets() {
    const auto is_modal = [](const AnchoredTarget& target) {
      const auto* region = std::get_if<RegionTarget>(&target.start.target.shape);
      return region != nullptr && region->extent == Extent::modal;
    };
    if (std::ranges::none_of(targets, is_modal)) return;
    const int margin = std::min(cameras.front().rule.edge_margin, planning::max_clearance - 1);
    if (!modal_judge || !modal_judge->set(targets, start))
      modal_judge =
          std::make_unique<CameraPredictor>(robot, cameras.front(), targets, start, margin + 1);
    const Sample sample = modal_judge->at(0.0, start.positions);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      Target& target = targets[i].start.target;
      if (!is_modal(targets[i]) || !target.fault.empty()) continue;
      if (!(sample.predictions[i].clearance > margin))
        target.fault =
            "the robot is next to it at the start, and may hide a part of it: give the "
            "full extent as amodal";
    }
  }

  Robot robot;
  std::vector<ForecastCamera> cameras;
  LookAheadConfig config;
  RobotPose start;
  std::vector<AnchoredTarget> targets;
  std::vector<std::unique_ptr<CameraPredictor>> judges;  // made when first used
  std::unique_ptr<CameraPredictor> modal_judge;          // likewise; measures clearances
};

LookAhead::LookAhead(const Robot& robot, std::vector<ForecastCamera> cameras,
                     const std::vector<ForecastTarget>& targets, RobotPose start,
                     const LookAheadConfig& config)
    : state_(std::make_unique<State>(State{robot, std::move(cameras), config, {}, {}, {}, {}})) {
  check(config);
  check_is_drawn(robot);
  if (state_->cameras.empty()) throw InputError("look-ahead: no camera is given");
  state_->set(targets, std::move(start));
  state_->judges.resize(state_->cameras.size() * static_cast<std::size_t>(config.threads));
  for (std::size_t i = 0; i < state_->cameras.size(); ++i) static_cast<void>(state_->judge(i, 0));
}
LookAhead::~LookAhead() = default;
LookAhead::LookAhead(LookAhead&&) noexcept = default;
LookAhead& LookAhead::operator=(LookAhead&&) noexcept = default;

void LookAhead::set(const std::vector<ForecastTarget>& targets, RobotPose start) {
  state_->set(targets, std::move(start));
}

std::vector<TargetForecast> LookAhead::along(const Trajectory& trajectory, double from,
                                             double until) {
  State& s = *state_;
  const auto threads = static_cast<std::size_t>(s.config.threads);
  from = std::clamp(from, 0.0, trajectory.duration());
  until = std::clamp(until, from, trajectory.duration());
  const double length = until - from, least = std::max(least_step, length / most_samples);
  const auto steps =
      static_cast<std::size_t>(std::min(std::ceil(length / s.config.step), most_steps));
  std::vector<double> times;
  for (std::size_t i = 0; i <= steps; ++i)
    times.push_back(std::lerp(
        from, until, steps == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(steps)));
  // Pieces of equal length, several for each thread, since their cost differs.
  constexpr std::size_t pieces_of_thread = 4;
  const std::size_t pieces =
      threads == 1 ? 1 : std::clamp<std::size_t>(pieces_of_thread * threads, 1, steps + 1);
  std::vector<std::vector<Sample>> sampled(s.cameras.size() * pieces);
  parallel_for(s.config.threads, sampled.size(), [&](std::size_t thread, std::size_t i) {
    const std::size_t first = i % pieces * steps / pieces, last = (i % pieces + 1) * steps / pieces;
    Sampler sampler(s.judge(i / pieces, thread), trajectory, s.config, least,
                    s.robot.variables().size());
    sampled[i] = sampler.at_least(std::span(times).subspan(first, last - first + 1));
    if (i % pieces > 0) sampled[i].erase(sampled[i].begin());  // the last piece's last
  });
  std::vector<TargetForecast> forecasts;
  for (std::size_t t = 0; t < s.targets.size(); ++t) {
    TargetForecast& forecast = forecasts.emplace_back();
    forecast.name = s.targets[t].start.target.name;
    forecast.cameras.resize(s.cameras.size());
    for (std::size_t i = 0; i < sampled.size(); ++i)
      for (Sample& sample : sampled[i]) {
        forecast.cameras[i / pieces].times.push_back(sample.time);
        forecast.cameras[i / pieces].predictions.push_back(std::move(sample.predictions[t]));
      }
    for (CameraForecast& camera : forecast.cameras) camera.intervals = intervals_of(camera);
    forecast.any.intervals = together(forecast.cameras);
  }
  return forecasts;
}

std::vector<LookAhead::Seen> LookAhead::visibility(std::size_t camera,
                                                   std::span<const double> positions) {
  State& s = *state_;
  const std::size_t variables = s.robot.variables().size();
  if (camera >= s.cameras.size())
    throw std::invalid_argument("there is no camera " + std::to_string(camera));
  if (variables == 0 || positions.size() % variables != 0)
    throw std::invalid_argument(std::to_string(positions.size()) +
                                " positions are not whole rows of " + std::to_string(variables));
  const std::size_t rows = positions.size() / variables, targets = s.targets.size();
  std::vector<Seen> seen(rows * targets);
  constexpr std::size_t block = 64;  // rows that a thread takes at once
  parallel_for(
      s.config.threads, (rows + block - 1) / block, [&](std::size_t thread, std::size_t i) {
        CameraPredictor& judge = s.judge(camera, thread);
        for (std::size_t row = i * block; row < std::min(rows, (i + 1) * block); ++row) {
          const Sample sample = judge.at(0.0, positions.subspan(row * variables, variables));
          for (std::size_t t = 0; t < targets; ++t) {
            const Prediction& prediction = sample.predictions[t];
            const bool is_known = prediction.verdict != Verdict::unknown &&
                                  prediction.verdict != Verdict::out_of_view;
            seen[row * targets + t] = {is_known ? static_cast<float>(prediction.hidden)
                                                : std::numeric_limits<float>::quiet_NaN(),
                                       static_cast<float>(prediction.clearance)};
          }
        }
      });
  return seen;
}

std::vector<RankedMotion> rank(std::span<const std::vector<TargetForecast>> forecasts) {
  const auto duration_of = [&](std::size_t motion) {
    return forecasts[motion].empty() ? 0.0 : forecasts[motion].front().any.intervals.back().end;
  };
  std::vector<RankedMotion> ranked;
  for (std::size_t i = 0; i < forecasts.size(); ++i) {
    double seen = 0.0;
    for (const TargetForecast& forecast : forecasts[i])
      seen += forecast.any.seen_for() / static_cast<double>(forecasts[i].size());
    const double duration = duration_of(i);
    ranked.push_back({i, duration > 0.0 ? seen / duration : 0.0, reason_of(forecasts[i])});
  }
  std::ranges::stable_sort(ranked, [&](const RankedMotion& a, const RankedMotion& b) {
    return a.seen != b.seen ? a.seen > b.seen
                            : duration_of(a.trajectory) < duration_of(b.trajectory);
  });
  return ranked;
}

}  // namespace penumbra
