// SPDX-License-Identifier: Apache-2.0
// Labels of lidar scans of robots in a room, against MuJoCo's rays at each point's own time.
// bench/lidar_study.cpp has more cases and more points.
#include "../support/test.hpp"
#include "lidar_scenes.hpp"

#include <penumbra/tuning/cloud_tuning.hpp>

namespace penumbra::test {
namespace {

constexpr double deviation = 0.01, sigmas = 3.5;
/// Of the points. 0.023 % of a normal distribution lies more than 3.5 deviations before a surface.
constexpr double tail = 0.0004;
/// Points whose beam may have met other links, or the room, than their ray.
constexpr double few = 0.001;
/// Of the mixtures: noise moves them out of the ranges that become fringe.
constexpr double veil_at_limits = 0.05;
/// A part of a scan has the poses of its middle: next to outlines, what moves may be elsewhere.
constexpr double left_by_parts = 0.001, wrong_by_parts = 0.005, removed_by_parts = 0.001;
/// With the poses of the scan's middle for all points.
constexpr double left_without_times = 10.0 * left_by_parts;

struct Scores {
  LidarScore with_times, without;
};

Scores scores(const LidarRobot& robot, const LidarMount& mount, bool moves, int scans,
              const std::function<std::vector<LidarRay>(std::size_t)>& rays_of) {
  LidarWorld world(robot, mount, 5);
  Pipeline pipeline(world.robot(), CloudConfig{.rule = {.tolerance = {.a = sigmas * deviation}},
                                               .sensor_parent = mount.parent,
                                               .T_parent_sensor = mount.T_parent_sensor});
  const JointMotion path = lidar_motion(robot, world.robot(), Wave::sine, 5);
  Scores out;
  for (int i = 0; i < scans; ++i) {
    const auto rays = rays_of(std::size_t(i));
    const double begin = 0.71 * i;
    const JointMotion motion = moves ? path : [still = path(begin)](double) { return still; };
    world.place_objects(motion, begin, begin + rays.back().time);
    const LidarScan scan = world.scan(rays, motion, begin, deviation);
    const FrameReport& report = process(pipeline, scan, motion, true);
    EXPECT_EQ(report.status, FrameStatus::ok) << report.message;
    out.with_times.add(scan, report);
    out.without.add(scan, process(pipeline, scan, motion, false));
  }
  EXPECT_EQ(out.with_times.false_measurements, 0U);
  return out;
}

std::vector<LidarRay> spin(std::size_t) {
  return spinning_lidar(32, 1024, std::numbers::pi / 10.0);
}

LidarMount mount_at(const std::string& link, const Vector3d& at, const AngleAxisd& turned) {
  LidarMount mount{link, Isometry3d(turned)};
  mount.T_parent_sensor.translation() = at;
  return mount;
}

const LidarMount beside_the_cell =
    mount_at("cell", {1.5, 0.2, 1.0}, AngleAxisd(std::numbers::pi, Vector3d::UnitZ()));

double fraction(std::size_t count, std::size_t of) { return double(count) / double(of); }

void expect_times_needed(const Scores& scores, std::size_t least_robot) {
  const auto& [with_times, without] = scores;
  ASSERT_GT(with_times.robot, least_robot);
  EXPECT_LT(fraction(with_times.left, with_times.robot), left_by_parts);
  EXPECT_LT(fraction(with_times.wrong_links, with_times.robot), wrong_by_parts);
  EXPECT_LT(fraction(with_times.removed, with_times.room), removed_by_parts);
  EXPECT_GT(fraction(without.left, without.robot), left_without_times);
}

TEST(LidarTruth, ArmsThatMoveNeedTheTimesOfThePoints) {
  expect_times_needed(scores(lidar_arms(2), beside_the_cell, true, 4, spin), 3000U);
}

TEST(LidarTruth, LidarOnAnArmThatMovesNeedsThemToo) {
  const LidarMount mount = mount_at("1_forearm", {0.12, 0.0, 0.15},
                                    AngleAxisd(-std::numbers::pi / 2.0, Vector3d::UnitX()));
  expect_times_needed(scores(lidar_arms(1), mount, true, 2, rosette_lidar), 10000U);
}

/// Two arms that move, before a sensor.
struct TunedWorld {
  LidarWorld world{lidar_arms(2), beside_the_cell, 7};
  JointMotion motion = lidar_motion(lidar_arms(2), world.robot(), Wave::sine, 7);

  /// `shift`: by how much the sensor's pose is wrong.
  Pipeline pipeline(const CloudRule& rule, const Vector3d& shift = Vector3d::Zero()) const {
    const Isometry3d T = Translation3d(shift) * beside_the_cell.T_parent_sensor;
    return Pipeline(
        world.robot(),
        CloudConfig{.rule = rule, .sensor_parent = beside_the_cell.parent, .T_parent_sensor = T});
  }
  CloudTuning tune(Pipeline pipeline, double noise) {
    CloudTuner tuner{CloudRule()};
    for (int i = 0; i < 12; ++i)
      tuner.add(pipeline, frame_of(world.scan(spin(0), motion, 0.71 * i, noise), motion));
    return tuner.result();
  }
};

TEST(LidarTruth, NoiseAndBeamAreMeasured) {
  constexpr double within = 0.1, bias = 0.002;  // of the deviation; metres
  for (const double noise : {0.01, 0.03}) {
    TunedWorld arms;
    const CloudTuning tuning = arms.tune(arms.pipeline({}), noise);
    std::cout << "noise " << noise << ": deviation " << tuning.deviation << ", bias " << tuning.bias
              << ", beam " << tuning.rule.beam << " of " << LidarWorld::beam << '\n';
    EXPECT_TRUE(tuning.problems.empty()) << tuning.problems.front();
    EXPECT_NEAR(tuning.deviation, noise, within * noise);
    EXPECT_NEAR(tuning.bias, 0.0, bias);
    Pipeline pipeline = arms.pipeline(tuning.rule);
    LidarScore score;
    for (int i = 0; i < 8; ++i) {
      const LidarScan scan = arms.world.scan(spin(0), arms.motion, 0.37 + 0.71 * i, noise);
      score.add(scan, process(pipeline, scan, arms.motion, true));
    }
    ASSERT_GT(score.veil, 50U);
    EXPECT_LT(fraction(score.left, score.robot), left_by_parts);
    EXPECT_LT(fraction(score.veil_left, score.veil), veil_at_limits);
    EXPECT_LT(fraction(score.removed, score.room), removed_by_parts);
  }
}

TEST(LidarTruth, AWrongPoseIsNotTunedAway) {
  for (const Vector3d& shift : {Vector3d(0.05, 0, 0), Vector3d(0, 0.1, 0)}) {
    TunedWorld arms;
    const CloudTuning tuning = arms.tune(arms.pipeline({}, shift), 0.01);
    ASSERT_FALSE(tuning.problems.empty()) << tuning.deviation;
    EXPECT_TRUE(holds(tuning.problems[0], "correct the sensor's pose"));
  }
}

TEST(LidarTruth, QuadrupedThatStands) {
  const auto [score, same] = scores(
      lidar_quadruped(), mount_at("trunk", {0.0, 0.0, 0.19}, AngleAxisd(0.4, Vector3d::UnitY())),
      false, 1, spin);
  ASSERT_GT(score.robot, 5000U);
  ASSERT_GT(score.veil, 50U);
  EXPECT_LT(fraction(score.left, score.robot), tail);
  EXPECT_LT(fraction(score.wrong_links, score.robot), few);
  EXPECT_LT(fraction(score.removed, score.room), few);
  EXPECT_LT(fraction(score.veil_left, score.veil), veil_at_limits);
  EXPECT_EQ(score.left, same.left);
}

}  // namespace
}  // namespace penumbra::test
