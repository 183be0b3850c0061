// SPDX-License-Identifier: Apache-2.0
// urdfdom, the reader that ROS uses, as the oracle of ours.
#include "../support/data.hpp"
#include "plain_robot.hpp"
#include "urdf_text.hpp"

#include <urdf_parser/urdf_parser.h>

namespace penumbra::test {
namespace {

// Both read the same digits; a rotation goes through a quaternion on urdfdom's side.
constexpr double kReadTolerance = 1e-14;

const std::vector<std::string> kItsTypes = {"revolute", "continuous", "prismatic", "fixed"};

Matrix matrix_of(const urdf::Pose& pose) {
  const auto& q = pose.rotation;
  return translation({pose.position.x, pose.position.y, pose.position.z}) *
         quaternion(q.x, q.y, q.z, q.w);
}

const std::map<int, std::string> kTypeNames{{urdf::Joint::REVOLUTE, "revolute"},
                                            {urdf::Joint::CONTINUOUS, "continuous"},
                                            {urdf::Joint::PRISMATIC, "prismatic"},
                                            {urdf::Joint::FIXED, "fixed"}};

PlainRobot plain_robot(const urdf::ModelInterface& model) {
  PlainRobot robot;
  for (const auto& [name, link] : model.links_) robot.links.push_back(name);
  for (const auto& [name, joint] : model.joints_) {
    PlainJoint out;
    out.name = name;
    out.type = kTypeNames.at(joint->type);
    out.parent = joint->parent_link_name;
    out.child = joint->child_link_name;
    out.origin = matrix_of(joint->parent_to_joint_origin_transform);
    out.axis = {joint->axis.x, joint->axis.y, joint->axis.z};
    if (joint->limits) {
      out.lower = joint->limits->lower;
      out.upper = joint->limits->upper;
    }
    if (joint->mimic) {
      out.mimics = joint->mimic->joint_name;
      out.multiplier = joint->mimic->multiplier;
      out.offset = joint->mimic->offset;
    }
    robot.joints.push_back(out);
  }
  return robot;
}

void expect_same_joint(const Robot& robot, const Joint& ours, const PlainJoint& theirs) {
  SCOPED_TRACE(ours.name);
  EXPECT_EQ(to_string(ours.type), theirs.type);
  EXPECT_EQ(robot.links()[ours.parent], theirs.parent);
  EXPECT_EQ(robot.links()[ours.child], theirs.child);
  expect_pose(ours.origin, theirs.origin, "origin");
  EXPECT_EQ(ours.mimics, !theirs.mimics.empty());
  if (ours.type == JointType::fixed) return;
  EXPECT_LT((ours.axis - theirs.axis.normalized()).cwiseAbs().maxCoeff(), kReadTolerance);
  if (!ours.lower) return;
  EXPECT_EQ(*ours.lower, theirs.lower);
  EXPECT_EQ(*ours.upper, theirs.upper);
}

void expect_same_robot(Random& random, const std::string& xml, const Robot& robot) {
  const auto model = urdf::parseURDF(xml);
  ASSERT_TRUE(model);
  const PlainRobot plain = plain_robot(*model);
  ASSERT_EQ(robot.links().size(), plain.links.size());
  ASSERT_EQ(robot.joints().size(), plain.joints.size());
  EXPECT_EQ(robot.name(), model->getName());
  EXPECT_EQ(robot.links()[0], model->getRoot()->name);
  for (const Joint& ours : robot.joints())
    for (const PlainJoint& theirs : plain.joints)
      if (theirs.name == ours.name) expect_same_joint(robot, ours, theirs);
  expect_kinematics(random, robot, plain);
}

class RealUrdf : public ::testing::TestWithParam<std::string> {};

TEST_P(RealUrdf, AgreesWithUrdfdom) {
  PENUMBRA_REQUIRE_DATA();
  Random random = seeded_random(4);
  const auto file = data_folder() / "robots" / GetParam() / (GetParam() + ".urdf");
  // The trees are compared, not the meshes.
  expect_same_robot(random, read_bytes(file), Robot::load(file, {.ignore_links = {"*"}}));
}

INSTANTIATE_TEST_SUITE_P(Robots, RealUrdf, ::testing::Values("ur5e", "xarm7"));

TEST(Urdfdom, AgreesOnRandomTrees) {
  Random random = seeded_random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const std::string xml =
        urdf_text(random, random_robot(random, 1 + below(random, 30), kItsTypes));
    expect_same_robot(random, xml, parse(xml));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

}  // namespace
}  // namespace penumbra::test
