// SPDX-License-Identifier: Apache-2.0
// What a motion will hide, against rays that Embree casts every millisecond.
#include "box_rays.hpp"

#include <penumbra/planning/look_ahead.hpp>

namespace penumbra::test {
namespace {

constexpr double truth_step = 0.001;  // seconds
/// A random motion of an arm before a camera, and boxes that stand behind places where it passes.
struct Scene {
  Scene(const Robot& robot_, std::mt19937_64& random) : robot(robot_) {
    const std::vector<std::string> names(robot.variables().begin(), robot.variables().end());
    std::vector<double> start = robot.rest_positions();
    std::vector<TrajectoryPoint> points;
    double time = 0.0;
    for (int i = 0; i < 4; ++i) {
      TrajectoryPoint point{.time = time};
      for (double& value : start) {
        point.positions.push_back(i == 0 ? uniform(random, -1.5, 1.5)
                                         : points.back().positions[point.positions.size()] +
                                               uniform(random, -0.8, 0.8));
        point.velocities.push_back(0.0);
        point.accelerations.push_back(0.0);
        value = point.positions.back();
      }
      if (i == 0) first = start;
      points.push_back(std::move(point));
      time += uniform(random, 0.3, 1.0);
    }
    trajectory.emplace(robot, names, std::move(points), first);
    T_root_camera = random_viewpoint(random);
    const int count = std::uniform_int_distribution(1, 10)(random);
    while (int(boxes.size()) < count) add_box(random);
  }

  void add_box(std::mt19937_64& random) {
    std::vector<double> positions(robot.variables().size());
    trajectory->at(uniform(random, 0.0, trajectory->duration()), positions);
    std::vector<Isometry3d> T(robot.links().size());
    robot.forward_kinematics(positions, T);
    const Vector3d from = T_root_camera.translation();
    const Vector3d at = T[random() % T.size()].translation();
    const Vector3d place = at + uniform(random, 0.1, 0.6) * (at - from).normalized() +
                           0.1 * random_triple(random, 1.0);
    boxes.push_back(random_box(random, place, 0.04, 0.14));
  }

  [[nodiscard]] std::vector<ForecastTarget> targets() const {
    std::vector<ForecastTarget> all;
    for (const BoxTarget& box : boxes)
      all.push_back({.target = {.name = "box" + std::to_string(all.size()), .shape = box}});
    return all;
  }

  const Robot& robot;
  std::vector<double> first;
  std::optional<Trajectory> trajectory;
  Isometry3d T_root_camera;
  std::vector<BoxTarget> boxes;
};

/// Counts over all motions, as they are printed.
struct Tally {
  std::size_t both = 0, neither = 0, missed = 0, invented = 0;  // milliseconds of hidden
  std::size_t intervals = 0, lost = 0;                          // hidden for 30 ms and more
  std::vector<double> borders;                                  // seconds off
  std::size_t blamed = 0, blamed_right = 0;

  [[nodiscard]] double balanced() const {
    return 0.5 *
           (double(both) / double(both + missed) + double(neither) / double(neither + invented));
  }
};

constexpr double short_time = 0.03;  // seconds: what is shorter need not be found

/// The times at which a series is hidden, as [begin, end). Those at most `gap` seconds apart are
/// one.
std::vector<std::pair<double, double>> hidden_times(const std::vector<Truth>& truth,
                                                    double threshold, double gap = 0.0) {
  std::vector<std::pair<double, double>> times;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].hidden <= threshold) continue;
    const double time = double(i) * truth_step;
    if (times.empty() || time - times.back().second > gap + 0.5 * truth_step)
      times.emplace_back(time, time);
    times.back().second = time + truth_step;
  }
  return times;
}

/// Compares where hidden intervals begin and end. What is seen between two for a short time need
/// not be found, and makes no border.
void compare_borders(const CameraForecast& forecast,
                     const std::vector<std::pair<double, double>>& truth, double duration,
                     Tally& tally) {
  std::vector<std::pair<double, double>> said;
  for (const VerdictInterval& each : forecast.intervals) {
    if (each.verdict != Verdict::hidden) continue;
    if (said.empty() || each.begin - said.back().second > short_time)
      said.emplace_back(each.begin, each.begin);
    said.back().second = each.end;
  }
  for (const auto& [begin, end] : truth)
    for (const auto& found : said) {
      if (!(found.first < end && begin < found.second)) continue;
      if (begin > 0.0) tally.borders.push_back(std::abs(found.first - begin));
      if (end < duration) tally.borders.push_back(std::abs(found.second - end));
      break;
    }
}

void compare(const CameraForecast& forecast, const std::vector<Truth>& truth, const Robot& robot,
             const TargetThresholds& thresholds, Tally& tally) {
  std::vector<const VerdictInterval*> hidden;
  for (const VerdictInterval& each : forecast.intervals)
    if (each.verdict == Verdict::hidden) hidden.push_back(&each);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double time = double(i) * truth_step;
    const bool foreseen = std::ranges::any_of(
        hidden, [&](const auto* each) { return each->begin <= time && time < each->end; });
    const bool is_so = truth[i].hidden > thresholds.hidden_enter;
    ++(is_so ? (foreseen ? tally.both : tally.missed)
             : (foreseen ? tally.invented : tally.neither));
  }
  for (const auto& [begin, end] : hidden_times(truth, thresholds.hidden_enter)) {
    const VerdictInterval* found = nullptr;
    for (const VerdictInterval* each : hidden)
      if (each->begin < end && begin < each->end) found = each;
    if (end - begin < short_time) continue;
    ++tally.intervals;
    tally.lost += found == nullptr ? 1 : 0;
  }
  compare_borders(forecast, hidden_times(truth, thresholds.hidden_enter, short_time),
                  double(truth.size() - 1) * truth_step, tally);
  for (std::size_t i = 0; i < forecast.times.size(); ++i) {
    const Truth& at =
        truth[std::min(truth.size() - 1, std::size_t(std::lround(forecast.times[i] / truth_step)))];
    const Prediction& prediction = forecast.predictions[i];
    if (prediction.verdict == Verdict::out_of_view) continue;
    if (at.hidden < thresholds.partial_enter || prediction.by.empty()) continue;
    ++tally.blamed;
    tally.blamed_right += prediction.by == robot.links()[at.by] ? 1 : 0;
  }
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[std::size_t(part * double(values.size() - 1))];
}

void judge_motions(const Robot& robot, int motions, std::mt19937_64& random, Tally& tally) {
  LinkRays links(robot);
  std::vector<Isometry3d> T(robot.links().size());
  std::vector<double> positions(robot.variables().size());
  for (int motion = 0; motion < motions; ++motion) {
    const Scene scene(robot, random);
    ForecastCamera camera{.name = "cell", .camera = forecast_camera()};
    camera.camera.T_parent_camera = scene.T_root_camera;
    const std::vector<TargetForecast> forecasts =
        LookAhead(robot, {camera}, scene.targets(), RobotPose{.positions = scene.first})
            .along(*scene.trajectory);
    std::vector<std::vector<TargetRay>> rays;
    for (const BoxTarget& box : scene.boxes)
      rays.push_back(rays_of(box, scene.T_root_camera, camera.camera.intrinsics));
    std::vector<std::vector<Truth>> truth(rays.size());
    for (double time = 0.0; time <= scene.trajectory->duration(); time += truth_step) {
      scene.trajectory->at(time, positions);
      robot.forward_kinematics(positions, T);
      links.place(T);
      for (std::size_t i = 0; i < rays.size(); ++i)
        if (!rays[i].empty())
          truth[i].push_back(
              truth_of(rays[i], links, scene.T_root_camera.translation(), camera.rule.tolerance));
    }
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!rays[i].empty())
        compare(forecasts[i].cameras[0], truth[i], robot, TargetThresholds{}, tally);
  }
}

TEST(LookAhead, AgreesWithRaysEveryMillisecond) {
  std::mt19937_64 random = seeded_random(391);
  const int motions = measures_in_full() ? 100 : 2;
  Tally tally;
  for (const Robot& robot : arms()) judge_motions(robot, motions, random, tally);
  std::cout << "hidden " << tally.both + tally.missed << " ms, balanced accuracy "
            << 100 * tally.balanced() << " %, intervals of 30 ms " << tally.intervals << ", lost "
            << tally.lost << ", borders off: median " << 1e3 * quantile(tally.borders, 0.5)
            << ", 99 % " << 1e3 * quantile(tally.borders, 0.99) << ", most "
            << 1e3 * quantile(tally.borders, 1.0) << " ms, blame right "
            << 100.0 * double(tally.blamed_right) / double(tally.blamed) << " % of " << tally.blamed
            << '\n';
  EXPECT_GT(tally.both, 0U);
  EXPECT_GT(tally.balanced(), 0.995);
  EXPECT_EQ(tally.lost, 0U);
  EXPECT_LT(quantile(tally.borders, 0.95), 0.010);
  EXPECT_GT(double(tally.blamed_right), 0.98 * double(tally.blamed));
}

}  // namespace
}  // namespace penumbra::test
