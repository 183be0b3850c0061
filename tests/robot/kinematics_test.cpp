// SPDX-License-Identifier: Apache-2.0
#include "plain_robot.hpp"
#include "urdf_text.hpp"

namespace penumbra::test {
namespace {

const std::vector<std::string> kAllTypes = {"revolute", "continuous", "prismatic",
                                            "fixed",    "planar",     "floating"};

std::vector<Isometry3d> pose(const Robot& robot, const std::vector<double>& positions) {
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  return poses;
}

Robot one_joint(const std::string& type, const std::string& body) {
  return parse(robot_xml(link_xml("a") + link_xml("b") + joint_xml("j", type, "a", "b", body)));
}

/// Parents stand before their children, and joints in the order of the links that they move.
void expect_order(const Robot& robot, const PlainRobot& plain) {
  ASSERT_EQ(robot.links().size(), plain.links.size());
  ASSERT_EQ(robot.joints().size(), plain.joints.size());
  for (std::size_t i = 0; i < robot.joints().size(); ++i) {
    EXPECT_EQ(robot.joints()[i].child, i + 1);
    EXPECT_LE(robot.joints()[i].parent, i);
    EXPECT_EQ(robot.find_link(robot.links()[i]), i);
  }
  for (std::size_t i = 0; i < robot.variables().size(); ++i)
    EXPECT_EQ(robot.find_variable(robot.variables()[i]), i);
  EXPECT_FALSE(robot.find_link("link_60"));
  EXPECT_FALSE(robot.find_variable(""));
}

TEST(Kinematics, RandomTreesMatchPlainMatrices) {
  Random random = seeded_random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const PlainRobot plain = random_robot(random, 1 + below(random, 30), kAllTypes);
    const Robot robot = parse(urdf_text(random, plain));
    expect_order(robot, plain);
    expect_kinematics(random, robot, plain);
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(Kinematics, WhatIsNotGivenFollowsTheSpecification) {
  EXPECT_TRUE(pose(one_joint("prismatic", ""), {2.0})[1].isApprox(at(2, 0, 0), kPoseTolerance));
  EXPECT_EQ(one_joint("fixed", "<axis xyz=\"0 0 0\"/><mimic joint=\"gone\"/>").variables().size(),
            0u);
  EXPECT_EQ(one_joint("planar", "<axis xyz=\"0 0 1\"/>").variables()[2], "j/yaw");
  const Robot floating = one_joint("floating", "");
  EXPECT_EQ(floating.variables()[6], "j/qw");
  EXPECT_EQ(floating.rest_positions(), (std::vector<double>{0, 0, 0, 0, 0, 0, 1}));
  const Robot both = one_joint("revolute", "<limit lower=\"-1\" upper=\"2\" effort=\"9\"/>");
  EXPECT_EQ(both.joints()[0].lower, -1.0);
  EXPECT_EQ(both.joints()[0].upper, 2.0);
  EXPECT_EQ(one_joint("prismatic", "<limit upper=\"2\"/>").joints()[0].lower, 0.0);
  EXPECT_FALSE(one_joint("continuous", "<limit lower=\"-1\" upper=\"2\"/>").joints()[0].lower);
  EXPECT_FALSE(one_joint("revolute", "").joints()[0].lower);
}

TEST(Kinematics, HeldJointsStandWhereTheyWouldMove) {
  Random random = seeded_random(5);
  std::size_t held = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const std::string text =
        urdf_text(random, random_robot(random, 2 + below(random, 20), kAllTypes));
    const Robot free = parse(text);
    std::vector<double> positions = free.rest_positions(), rest;
    RobotOptions options;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::string& name = free.variables()[i];
      const bool has_one = name.find('/') == std::string::npos;
      if (has_one) positions[i] = uniform(random, -0.1, 0.1);
      if (has_one && below(random, 2) == 0)
        options.joints[name] = positions[i];
      else
        rest.push_back(positions[i]);
    }
    const Robot robot = Robot::parse(text, "", options);
    held += options.joints.size();
    ASSERT_EQ(robot.variables().size(), rest.size());
    const auto moved = pose(free, positions), stands = pose(robot, rest);
    for (std::size_t i = 0; i < moved.size(); ++i)
      EXPECT_TRUE(stands[i].isApprox(moved[i], kPoseTolerance)) << text;
  }
  EXPECT_GT(held, 100u);
  const auto hold = [](const std::string& joint, double position) {
    return Robot::parse(
        robot_xml(link_xml("a") + link_xml("b") +
                  joint_xml("j", "prismatic", "a", "b", "<limit lower=\"0\" upper=\"0.04\"/>")),
        "", {.joints = {{joint, position}}});
  };
  EXPECT_TRUE(hold("j", 0.04).variables().empty());
  expect_refused([&] { hold("j", 40.0); }, {"'j'", "40", "0.04"});
  expect_refused([&] { hold("k", 0.0); }, {"'k'"});
}

}  // namespace
}  // namespace penumbra::test
