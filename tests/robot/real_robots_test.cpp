// SPDX-License-Identifier: Apache-2.0
#include "../support/data.hpp"
#include "urdf_text.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

Robot load(const std::string& name, Geometry geometry) {
  return Robot::load(data_folder() / "robots" / name / (name + ".urdf"), {.geometry = geometry});
}

void expect_sound(const Robot& robot, std::size_t drawn) {
  std::size_t count = 0;
  for (const LinkReport& report : robot.report()) {
    EXPECT_FALSE(report.missing) << report.reason;
    if (!report.drawn) continue;
    ++count;
    EXPECT_GT(report.triangles, 100u) << report.link;
    // A link of these arms is 5 cm to 70 cm long.
    EXPECT_GT(report.bounds.sizes().maxCoeff(), 0.05) << report.link;
    EXPECT_LT(report.bounds.sizes().maxCoeff(), 0.7) << report.link;
  }
  EXPECT_EQ(count, drawn);
}

TEST(RealRobots, Ur5eIsDrawnWhole) {
  PENUMBRA_REQUIRE_DATA();
  const Robot collision = load("ur5e", Geometry::collision);
  EXPECT_EQ(collision.variables().size(), 6u);
  EXPECT_EQ(collision.notes().size(), 1u);
  expect_sound(collision, 7);
}

TEST(RealRobots, VisualAndCollisionOfUr5eAgreeInSize) {
  PENUMBRA_REQUIRE_DATA();
  const Robot collision = load("ur5e", Geometry::collision);
  const Robot visual = load("ur5e", Geometry::visual);
  expect_sound(visual, 7);
  for (std::size_t i = 0; i < visual.links().size(); ++i) {
    if (!visual.report()[i].drawn) continue;
    const auto& v = visual.report()[i].bounds;
    const auto& c = collision.report()[i].bounds;
    EXPECT_LT((v.center() - c.center()).norm(), 0.02) << visual.links()[i];
    EXPECT_LT((v.sizes() - c.sizes()).norm(), 0.05) << visual.links()[i];
  }
}

TEST(RealRobots, Xarm7IsDrawnWhole) {
  PENUMBRA_REQUIRE_DATA();
  const Robot robot = load("xarm7", Geometry::visual);
  EXPECT_EQ(robot.variables().size(), 7u);
  expect_sound(robot, 8);
}

}  // namespace
}  // namespace penumbra::test
