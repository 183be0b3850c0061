// SPDX-License-Identifier: Apache-2.0
// Google Benchmark of looking ahead; and, to compare, of rendering whole images of the same
// configurations, and of a cone against spheres, which knows no shape and no link.
#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include <penumbra/planning/look_ahead.hpp>

namespace penumbra::bench {
namespace {

constexpr std::size_t waypoints = 1000;
const Intrinsics intrinsics(640, 480, 600, 600, 319.5, 239.5);

/// A camera 1.6 m before an arm, and boxes behind it.
struct Cell {
  explicit Cell(const std::string& name, Geometry geometry)
      : robot(Robot::load(data_folder() / "robots" / name / (name + ".urdf"),
                          {.geometry = geometry})) {
    Eigen::Matrix3d rotation;
    rotation << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    Eigen::Isometry3d& T = camera.camera.T_parent_camera.emplace(Eigen::Isometry3d::Identity());
    T.linear() = rotation;
    T.translation() = Eigen::Vector3d(1.6, 0.0, 0.4);
    std::mt19937_64 random(39);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 10; ++i) {
      BoxTarget box;
      box.frame = ReferenceFrame::root();
      box.pose.translation() =
          Eigen::Vector3d(-0.4, 0.5 * uniform(random), 0.4 + 0.3 * uniform(random));
      box.size.setConstant(0.2);  // 60 pixels
      targets.push_back({.target = {.name = "box" + std::to_string(i), .shape = box}});
    }
    const std::vector<std::string> names(robot.variables().begin(), robot.variables().end());
    std::vector<TrajectoryPoint> points;
    for (std::size_t i = 0; i < waypoints; ++i) {
      TrajectoryPoint point{.time = 0.02 * static_cast<double>(i)};
      for (std::size_t j = 0; j < names.size(); ++j)
        point.positions.push_back(
            1.2 * std::sin(0.3 * point.time * (1.0 + 0.2 * static_cast<double>(j))));
      positions.insert(positions.end(), point.positions.begin(), point.positions.end());
      points.push_back(std::move(point));
    }
    start = points.front().positions;
    trajectory.emplace(robot, names, std::move(points), start);
  }

  [[nodiscard]] LookAhead ahead(std::size_t count, int threads, int clearance) const {
    return {robot,
            {camera},
            {targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(count)},
            {.positions = start},
            {.threads = threads, .clearance = clearance}};
  }

  Robot robot;
  ForecastCamera camera{.name = "cell", .camera = {intrinsics, {}, {}, {}}};
  std::vector<ForecastTarget> targets;
  std::vector<double> start, positions;
  std::optional<Trajectory> trajectory;
};

void look_ahead(benchmark::State& state, const Cell& cell, int threads, int clearance) {
  LookAhead ahead = cell.ahead(10, threads, clearance);
  std::size_t samples = 0;
  for (auto _ : state) {
    const auto forecasts = ahead.along(*cell.trajectory);
    samples = forecasts[0].cameras[0].times.size();
  }
  state.counters["samples"] = static_cast<double>(samples);
}

void visibility(benchmark::State& state, const Cell& cell, int threads, int clearance) {
  LookAhead ahead = cell.ahead(1, threads, clearance);
  for (auto _ : state) benchmark::DoNotOptimize(ahead.visibility(0, cell.positions));
  state.counters["configurations/s"] = benchmark::Counter(
      static_cast<double>(waypoints * state.iterations()), benchmark::Counter::kIsRate);
}

/// Whole images, without any judging.
void render(benchmark::State& state, const Cell& cell) {
  const auto renderer = make_depth_renderer(Backend::cpu, intrinsics, bodies_of(cell.robot));
  std::vector<Eigen::Isometry3d> T(cell.robot.links().size());
  const std::size_t variables = cell.robot.variables().size();
  const Eigen::Isometry3d T_camera_root = cell.camera.camera.pose().inverse();
  for (auto _ : state)
    for (std::size_t i = 0; i < waypoints; ++i) {
      cell.robot.forward_kinematics({&cell.positions[i * variables], variables}, T);
      for (Eigen::Isometry3d& pose : T) pose = T_camera_root * pose;
      benchmark::DoNotOptimize(renderer->render(T));
    }
}

/// A cone from the camera around each target against the links' bounding spheres.
void cone(benchmark::State& state, const Cell& cell) {
  std::vector<Eigen::Isometry3d> T(cell.robot.links().size());
  const std::size_t variables = cell.robot.variables().size();
  const Eigen::Vector3d from = cell.camera.camera.pose().translation();
  for (auto _ : state) {
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < waypoints; ++i) {
      cell.robot.forward_kinematics({&cell.positions[i * variables], variables}, T);
      for (const ForecastTarget& target : cell.targets) {
        const Eigen::Vector3d to =
            std::get<BoxTarget>(target.target.shape).pose.translation() - from;
        for (std::size_t link = 0; link < T.size(); ++link) {
          const Eigen::AlignedBox3d& bounds = cell.robot.report()[link].bounds;
          if (bounds.isEmpty()) continue;
          const double radius = 0.5 * bounds.diagonal().norm();
          const Eigen::Vector3d at = T[link] * bounds.center() - from;
          const double along = std::clamp(at.dot(to) / to.squaredNorm(), 0.0, 1.0);
          hidden += (at - along * to).norm() < radius + 0.17 * along ? 1 : 0;
        }
      }
    }
    benchmark::DoNotOptimize(hidden);
  }
}

void add_cell(const std::string& name, const Cell& cell) {
  const auto add = [&](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((name + "/" + what).c_str(), run)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  for (const int threads : {1, 2})
    for (const int clearance : {0, 64}) {
      const std::string with =
          "/clearance:" + std::to_string(clearance) + "/threads:" + std::to_string(threads);
      add("look_ahead, 1000 waypoints, 10 targets" + with,
          [=, &cell](benchmark::State& state) { look_ahead(state, cell, threads, clearance); });
      add("visibility, 1000 configurations, 1 target" + with,
          [=, &cell](benchmark::State& state) { visibility(state, cell, threads, clearance); });
    }
  add("whole images, 1000", [&cell](benchmark::State& state) { render(state, cell); });
  add("cone against spheres, 1000, 10 targets",
      [&cell](benchmark::State& state) { cone(state, cell); });
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  using penumbra::Geometry;
  using penumbra::bench::Cell;
  const Cell ur5e("ur5e", Geometry::collision), xarm7("xarm7", Geometry::collision),
      visual("ur5e", Geometry::visual);
  penumbra::bench::add_cell("UR5e", ur5e);
  penumbra::bench::add_cell("xArm 7", xarm7);
  penumbra::bench::add_cell("UR5e, visual", visual);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
