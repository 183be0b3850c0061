// SPDX-License-Identifier: Apache-2.0
// Two of MuJoCo's arms that cross: which arm and link is on each ray, with both known, and with one
// whose joints are stale.
#include "simulated.hpp"

namespace penumbra::test {
namespace {

/// Pixels of all frames.
struct Counts {
  std::size_t robot = 0;      ///< of both arms
  std::size_t blamed = 0;     ///< of these, with the right link
  std::size_t right_arm = 0;  ///< of the right arm
  std::size_t trusted = 0;    ///< of these, clear or front
};

/// `links`: of the report, for each of MuJoCo's ids.
void add(const sim::SimFrame& truth, const FrameReport& report,
         const std::vector<std::size_t>& links, std::size_t first_right, Counts& counts) {
  for (const auto [u, v] : each_pixel(truth.ids)) {
    const std::int32_t id = truth.robot_ids(u, v);
    if (id == 0) continue;
    const std::size_t link = links[static_cast<std::size_t>(id)];
    ++counts.robot;
    counts.blamed += report.virtual_depth.links(u, v) == link + 1 ? 1 : 0;
    if (truth.ids(u, v) != id || link < first_right) continue;  // an object is before it
    ++counts.right_arm;
    counts.trusted += is_trusted(static_cast<Label>(report.labels(u, v))) ? 1 : 0;
  }
}

struct Ways {
  Counts both, right_stale;
};

Ways count(std::uint64_t seed, bool noisy, int frames) {
  sim::Simulation simulation("two_arms", without_color(seed, noisy));
  std::vector<PlacedRobot> arms;
  for (const auto& [name, T] : simulation.arms())
    arms.push_back({name, Robot::load(simulation.urdf(), {.geometry = Geometry::visual}), T});
  const Robot both = Robot::join(arms);
  Pipeline pipeline(both, simulation.camera());
  std::vector<std::size_t> links{0};  // of MuJoCo's ids
  for (const std::string& link : simulation.robot().links())
    links.push_back(both.find_link(link).value());
  const RobotPart& right = both.parts()[1];
  std::vector<std::size_t> of_right;
  for (std::size_t i = right.first_link; i < right.end_link; ++i) of_right.push_back(i);
  Ways ways;
  sim::SimFrame truth;
  std::vector<double> joints(both.variables().size());
  for (int i = 0; i < frames && simulation.next(truth); ++i) {
    for (std::size_t j = 0; j < joints.size(); ++j)
      joints[j] = truth.joints[simulation.robot().find_variable(both.variables()[j]).value()];
    const DepthView depth = std::as_const(truth.depth).view();
    const auto take = [&](const FrameReport& report, Counts& counts) {
      if (has_pose(report.status)) add(truth, report, links, right.first_link, counts);
    };
    take(pipeline.process({.depth = depth, .pose = {.positions = joints}}), ways.both);
    take(pipeline.process({.depth = depth,
                           .pose = {.positions = joints,
                                    .uncertain_links = of_right,
                                    .uncertain_reason = "stale"}}),
         ways.right_stale);
  }
  return ways;
}

using TwoArmsTruth = BothDepths;
INSTANTIATE_TEST_SUITE_P(Depth, TwoArmsTruth, testing::Bool(), depth_name);

TEST_P(TwoArmsTruth, EachRayHasTheRightArm) {
  const int frames = measures_in_full() ? 1000 : samples(60);
  constexpr double least_blame = 99.5;  // percent; rims differ by a pixel
  constexpr double most_trusted = 0.5;  // percent
  const auto [both, stale] = count(5, GetParam(), frames);
  EXPECT_GT(both.robot, static_cast<std::size_t>(1000 * frames));
  EXPECT_GT(percent(both.blamed, both.robot), least_blame);
  EXPECT_LT(percent(both.trusted, both.right_arm), most_trusted);
  EXPECT_EQ(stale.trusted, 0U) << "of what may be anywhere";
}

}  // namespace
}  // namespace penumbra::test
