// SPDX-License-Identifier: Apache-2.0
// Scans of lidars on and next to robots that stand and move: which labels Pipeline gives to
// points of which MuJoCo's rays know the truth. usage: lidar_study [SEED [SCANS PER CASE]]
#include "../tests/support/lidar_scenes.hpp"
#include "timing.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <penumbra/base/simd_target.hpp>
#include <penumbra/mesh/primitives.hpp>

namespace penumbra::bench {
namespace {

using namespace test;

constexpr double degree = std::numbers::pi / 180.0;
/// Of the noise: 0.02 % of a normal distribution lies farther before a surface.
constexpr double sigmas = 3.5;
/// A case has as many scans as it takes for enough points of the robot.
constexpr std::size_t enough_points = 20'000, least_scans = 5, most_scans = 100;

enum class Moves { none, sine, triangle };

struct Sensor {
  std::string name;
  std::function<std::vector<LidarRay>(std::size_t scan)> rays;
};

const std::vector<Sensor>& sensors() {
  static const std::vector<Sensor> all{
      {"16 beams", [](std::size_t) { return spinning_lidar(16, 1800, 15.0 * degree); }},
      {"64 beams", [](std::size_t) { return spinning_lidar(64, 1024, 22.5 * degree); }},
      {"128 beams", [](std::size_t) { return spinning_lidar(128, 1024, 45.0 * degree); }},
      {"rosette", rosette_lidar},
      {"plane", [](std::size_t) { return plane_scanner(); }}};
  return all;
}

struct Place {
  const LidarRobot& robot;
  std::string name;
  LidarMount mount;
};

struct Case {
  const Place& place;
  const Sensor& sensor;
  Moves moves = Moves::none;
  double noise = 0.02;  // metres
  double mixing = CloudRule().mixing;
};

double percent(std::size_t count, std::size_t of) {
  return of == 0 ? 0.0 : 100.0 * static_cast<double>(count) / static_cast<double>(of);
}

void run(const Case& c, std::uint64_t seed, std::size_t scans) {
  const LidarRobot& robot = c.place.robot;
  const LidarMount& mount = c.place.mount;
  LidarWorld world(robot, mount, seed);
  Pipeline pipeline(world.robot(),
                    CloudConfig{.rule = {.tolerance = {.a = sigmas * c.noise}, .mixing = c.mixing},
                                .sensor_parent = mount.parent,
                                .T_parent_sensor = mount.T_parent_sensor});
  const JointMotion path = lidar_motion(
      robot, world.robot(), c.moves == Moves::triangle ? Wave::triangle : Wave::sine, seed);
  sim::Random random(seed, 3);
  LidarScore with, without;
  std::vector<double> times;
  std::size_t parts = 0, scan = 0;
  for (; scan < scans && (with.robot < enough_points || scan < least_scans); ++scan) {
    const auto rays = c.sensor.rays(scan);
    const double begin = random.uniform(0.0, 1000.0);
    const JointMotion motion =
        c.moves == Moves::none ? [still = path(begin)](double) { return still; } : path;
    world.place_objects(motion, begin, begin + rays.back().time);
    const LidarScan points = world.scan(rays, motion, begin, c.noise);
    const FrameReport* report = nullptr;
    times.push_back(time_ms([&] { report = &process(pipeline, points, motion, true); }));
    if (report->status != FrameStatus::ok) throw std::logic_error(report->message);
    with.add(points, *report);
    parts += report->parts;
    without.add(points, process(pipeline, points, motion, false));
  }
  if (with.false_measurements != 0)
    throw std::logic_error("measurements and dropped rays are mixed up");
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                   times.end());
  static const std::array<const char*, 3> motions{"stands", "moves", "turns"};
  std::printf("%-9s %-7s %-9s %-6s %2.0f %5.1f %4zu %7zu %8zu %6zu %6zu |", robot.name.c_str(),
              c.place.name.c_str(), c.sensor.name.c_str(),
              motions.at(static_cast<std::size_t>(c.moves)), 100.0 * c.noise, c.mixing, scan,
              with.robot, with.room, with.veil, with.other_veil);
  std::printf(" %6.3f %6.3f %6.3f %6.3f %6zu %5zu %5zu %5.1f %5.1f |",
              percent(with.left, with.robot), percent(with.wrong_links, with.robot),
              percent(with.removed, with.room), percent(with.fringe, with.room), with.fringe,
              with.before, with.near, percent(with.veil_left, with.veil),
              percent(with.other_veil_left, with.other_veil));
  std::printf(" %6.3f %6.3f %6.3f %5.1f | %5.1f %6.2f\n", percent(without.left, without.robot),
              percent(without.wrong_links, without.robot), percent(without.removed, without.room),
              percent(without.veil_left, without.veil),
              static_cast<double>(parts) / static_cast<double>(scan), times[times.size() / 2]);
  std::fflush(stdout);
}

constexpr const char* legend = R"(
Robots are boxes, cylinders, balls and capsules; Penumbra's triangles differ from them by at most
%.2f mm. Each point is cast at its own time, with noise along its ray. 1 %% of the rays return
nothing. A beam is 3 mrad wide to all sides; one that meets robot and room returns a mixture of both
ranges with random weight, a veil point. Tolerance: %.1f times the noise, of which 0.02 %% of the
points lie farther before a surface. All joints move at up to 2 rad/s: "moves" as sines, "turns" as
triangles. Goals: left < 0.1 %%, links < 0.5 %%, removed < 0.1 %%.

cm        standard deviation of the noise       mixing    m, of the rule
robot     points on it                          room      points on what is around it
veil      mixtures up to 0.5 m behind the robot other     mixtures before it or farther behind
left      %% of the robot's points clear or front
links     %% of the robot's points occluded or beyond with a wrong link
removed   %% of the room's points neither clear nor front, without those of the next columns
fringe    %% of the room's points, and count, removed at most 3 mrad + 0.14 degrees from an outline
before    count of the room's points removed within the tolerance before the robot
rim       count of the room's other points removed at most 5 cm from the robot
v, o      %% of the veil and other veil points that are left
Then the same with all points at the time of the scan's middle. ms: median of a scan.

)";
constexpr const char* head =
    "robot     sensor            motion cm mixing scans  robot     room   veil  other |"
    "   left  links removed fringe         before  rim     v     o |"
    "   left  links removed     v | parts     ms\n";

LidarMount mount_at(const std::string& link, const Eigen::Vector3d& at, double degrees,
                    const Eigen::Vector3d& axis) {
  LidarMount mount{link, Eigen::Isometry3d::Identity()};
  mount.T_parent_sensor.translation() = at;
  mount.T_parent_sensor.linear() = Eigen::AngleAxisd(degrees * degree, axis).matrix();
  return mount;
}

void study(std::uint64_t seed, std::size_t scans) {
  std::printf("MuJoCo %s, %s, %s, 1 thread, seed %llu, at most %zu scans per case.\n",
              mj_versionString(), cpu_model().c_str(), simd_target_names().front().c_str(),
              static_cast<unsigned long long>(seed), scans);
  std::printf(legend, 1e3 * primitive_error, sigmas);
  std::printf("%s", head);
  const LidarRobot arm = lidar_arms(1), two = lidar_arms(2), quadruped = lidar_quadruped();
  const LidarMount beside = mount_at("cell", {1.5, 0.2, 1.0}, 180.0, Eigen::Vector3d::UnitZ());
  const std::array<Place, 3> places{
      {{arm, "beside", beside},
       {two, "beside", beside},
       {quadruped, "back", mount_at("trunk", {0.0, 0.0, 0.19}, 25.0, Eigen::Vector3d::UnitY())}}};
  const Place forearm{arm, "forearm",
                      mount_at("1_forearm", {0.12, 0.0, 0.15}, -90.0, Eigen::Vector3d::UnitX())};
  const std::array<Moves, 2> motions{Moves::none, Moves::sine};
  for (const Place* place : {&places[0], &forearm, &places[1], &places[2]})
    for (const Sensor& sensor : sensors())
      for (const Moves moves : motions) run({*place, sensor, moves}, seed, scans);
  const Sensor& usual = sensors()[1];
  for (const Place& place : places)
    for (const double noise : {0.01, 0.03})
      for (const Moves moves : motions) run({place, usual, moves, noise}, seed, scans);
  for (const Place& place : places) run({place, usual, Moves::triangle}, seed, scans);
  for (const Place& place : places) run({place, usual, Moves::none, 0.02, 10.0}, seed, scans);
}

}  // namespace
}  // namespace penumbra::bench

int main(int argc, char** argv) {
  try {
    penumbra::bench::study(argc > 1 ? std::stoull(argv[1]) : 11,
                           argc > 2 ? std::stoull(argv[2]) : penumbra::bench::most_scans);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
