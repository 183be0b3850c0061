// SPDX-License-Identifier: Apache-2.0
// What look-ahead says of a planned motion against what MuJoCo shows when the robot moves: 30 ms
// late and with a tracking error, over a parcel on a belt.
#include "simulated.hpp"

#include <penumbra/planning/look_ahead.hpp>

namespace penumbra::test {
namespace {

using ForecastTruth = SimulationTest;

constexpr double rate = 100.0;       // frames per second
constexpr double delay = 0.03;       // seconds by which the robot is behind its plan
constexpr double tracking = 0.005;   // rad: the largest error of a joint
constexpr double horizon = 2.0;      // seconds that are planned
constexpr double hidden_from = 0.9;  // TargetThresholds::hidden_enter
constexpr double clearly = 0.95;     // a share that a robot off its plan will pass, too

/// What happened.
struct Executed {
  std::vector<std::vector<double>> joints;
  std::vector<Eigen::Isometry3d> T_base_object;
  std::vector<double> hidden;  // share behind the robot

  [[nodiscard]] std::vector<double> joints_at(double frame) const {
    const double last = static_cast<double>(joints.size() - 1);
    const double at = std::clamp(frame, 0.0, last);
    const auto i = static_cast<std::size_t>(std::min(std::floor(at), last - 1.0));
    std::vector<double> between(joints[i].size());
    for (std::size_t j = 0; j < between.size(); ++j)
      between[j] = std::lerp(joints[i][j], joints[i + 1][j], at - static_cast<double>(i));
    return between;
  }
  /// Seconds until more than a share is hidden; null: not within the horizon.
  [[nodiscard]] std::optional<double> hidden_in(std::size_t from, double share) const {
    const auto last = std::min(hidden.size(), from + static_cast<std::size_t>(horizon * rate));
    for (std::size_t i = from; i < last; ++i)
      if (hidden[i] > share) return static_cast<double>(i - from) / rate;
    return std::nullopt;
  }
};

Executed execute(sim::Simulation& simulation) {
  Executed executed;
  sim::SimFrame frame;
  while (simulation.next(frame)) {
    const sim::ObjectTruth& parcel = frame.objects.front();
    if (parcel.pixels_alone == 0) continue;
    executed.joints.push_back(frame.true_joints);
    executed.T_base_object.push_back(parcel.T_base_object);
    executed.hidden.push_back(static_cast<double>(parcel.pixels_behind_robot) /
                              static_cast<double>(parcel.pixels_alone));
  }
  return executed;
}

struct Errors {
  std::vector<double> seconds;
  std::size_t missed = 0, invented = 0;
};

/// Compares at a time when the parcel is seen.
void compare(const sim::Simulation& simulation, const Executed& executed, std::size_t from,
             std::mt19937_64& random, Errors& errors) {
  const Robot& robot = simulation.robot();
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const std::vector<std::string> names(robot.variables().begin(), robot.variables().end());
  std::vector<double> amplitude, phase;
  for (std::size_t j = 0; j < names.size(); ++j) {
    amplitude.push_back(tracking * uniform(random));
    phase.push_back(3.0 * uniform(random));
  }
  std::vector<TrajectoryPoint> points;
  for (double time = 0.0; time <= horizon; time += 0.05) {
    TrajectoryPoint point{.time = time};
    point.positions = executed.joints_at(static_cast<double>(from) + rate * (time + delay));
    for (std::size_t j = 0; j < names.size(); ++j)
      point.positions[j] -= amplitude[j] * std::sin(phase[j] + 5.0 * time);
    points.push_back(std::move(point));
  }
  const Trajectory plan(robot, names, std::move(points), executed.joints[from]);
  constexpr std::size_t tenth = 10;  // frames by which the belt's speed is measured
  const Eigen::Isometry3d& now = executed.T_base_object[from];
  const Eigen::Isometry3d& before = executed.T_base_object[from - tenth];
  ForecastTarget parcel;
  parcel.target = {
      .name = "parcel",
      .shape = BoxTarget{
          .pose = now, .size = simulation.object_size(), .frame = ReferenceFrame::root()}};
  parcel.velocity = (now.translation() - before.translation()) * rate / tenth;
  const auto forecast = LookAhead(robot, {{.name = "camera", .camera = simulation.camera()}},
                                  {parcel}, {.positions = executed.joints[from]})
                            .along(plan);
  const CameraForecast& seen = forecast[0].cameras[0];
  const auto clear = std::ranges::find_if(
      seen.predictions, [](const Prediction& prediction) { return prediction.hidden > clearly; });
  const std::optional<double> said = seen.hidden_at();
  const std::optional<double> truth = executed.hidden_in(from, hidden_from);
  constexpr double last = horizon - 0.1;  // seconds: what happens later may be after the horizon
  if (said && truth)
    errors.seconds.push_back(std::abs(*said - *truth));
  else if (executed.hidden_in(from, clearly).value_or(horizon) < last)
    ++errors.missed;
  else if (clear != seen.predictions.end() && *said < last)
    ++errors.invented;
}

TEST_F(ForecastTruth, TellsWhenTheParcelGetsHidden) {
  constexpr double most_median = 0.035, most_p95 = 0.06;  // seconds: the delay, and a frame or two
  Errors errors;
  for (std::uint64_t seed = 1; seed <= (measures_in_full() ? 10U : 1U); ++seed) {
    sim::SimulationOptions options = without_color(seed, false);
    options.frame_rate = rate;
    sim::Simulation simulation("conveyor", options);
    const Executed executed = execute(simulation);
    std::mt19937_64 random(seed);
    for (std::size_t from = 10; from + 1 < executed.hidden.size(); from += 10)
      if (executed.hidden[from] < 0.5) compare(simulation, executed, from, random, errors);
  }
  ASSERT_GT(errors.seconds.size(), 5U);
  EXPECT_LT(quantile(errors.seconds, 0.5), most_median);
  EXPECT_LT(quantile(errors.seconds, 0.95), most_p95);
  EXPECT_EQ(errors.missed, 0U);
  EXPECT_EQ(errors.invented, 0U);
}

}  // namespace
}  // namespace penumbra::test
