// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <penumbra/poses/robot_pose.hpp>

namespace penumbra::test {
namespace {

constexpr double rounding = 1e-12;  // metres

RobotPose look_up(const Robot& robot, const PoseHistory& history, std::int64_t stamp,
                  const PoseOptions& options = {}) {
  RobotPose answer;
  PoseLookup(robot, options).at(history, stamp, answer);
  return answer;
}

void expect_uncertain(const RobotPose& answer, const std::vector<std::size_t>& links,
                      const std::string& reason) {
  EXPECT_EQ(answer.status, FrameStatus::ok) << answer.message;
  EXPECT_EQ(answer.uncertain_links, links);
  EXPECT_TRUE(holds(answer.uncertain_reason, reason));
}

void expect_fault(const RobotPose& answer, FrameStatus status, const std::string& names) {
  EXPECT_EQ(answer.status, status);
  EXPECT_TRUE(holds(answer.message, names));
}

class PoseLookupTest : public testing::Test {
 protected:
  void add_joint(std::int64_t stamp, double slide) {
    const std::string names[] = {"slide"};
    const double positions[] = {slide};
    history_.add_joints(stamp, names, positions);
  }

  /// As robot_state_publisher tells it.
  void add_slab(std::int64_t stamp, double slide) {
    history_.add_transform(stamp, "base", "slab", at(0, 0, 1 + slide));
  }

  const RobotPose& ask(std::int64_t stamp, const PoseOptions& options) {
    answer_ = look_up(robot_, history_, stamp, options);
    EXPECT_EQ(answer_.message.empty(), answer_.status == FrameStatus::ok) << answer_.message;
    return answer_;
  }

  Robot robot_ = slab_robot();
  PoseHistory history_{robot_};
  RobotPose answer_;
};

TEST_F(PoseLookupTest, ByJoints) {
  expect_fault(ask(5 * ms, {}), FrameStatus::missing_joints, "'slide': never seen");
  add_joint(10 * ms, 0.1);
  expect_fault(ask(15 * ms, {}), FrameStatus::stale_joints, "'slide'");
  add_joint(20 * ms, 0.12);
  EXPECT_EQ(ask(15 * ms, {}).status, FrameStatus::ok);
  EXPECT_NEAR(answer_.positions[0], 0.11, rounding);
  EXPECT_EQ(answer_.age, 5 * ms);
  EXPECT_FALSE(answer_.T_parent_camera);
  add_joint(30 * ms, 0.9);
  expect_fault(ask(25 * ms, {}), FrameStatus::stale_joints, "'slide': jumps");
}

TEST_F(PoseLookupTest, ByTransforms) {
  const PoseOptions options{.source = PoseSource::transforms};
  add_joint(10 * ms, 0.1);
  expect_fault(ask(10 * ms, options), FrameStatus::missing_transform, "'slab'");
  add_slab(10 * ms, 0.1);
  EXPECT_EQ(ask(10 * ms, options).status, FrameStatus::ok);
  expect_fault(ask(13 * ms, options), FrameStatus::stale_transform, "'slab' in 'base'");
  add_slab(20 * ms, 0.2);
  ASSERT_EQ(ask(13 * ms, options).status, FrameStatus::ok);
  EXPECT_EQ(answer_.age, 7 * ms);
  ASSERT_EQ(answer_.T_root_link.size(), 3U);
  EXPECT_TRUE(answer_.T_root_link[*robot_.find_link("slab")].isApprox(at(0, 0, 1.13), rounding));
  EXPECT_TRUE(answer_.T_root_link[*robot_.find_link("plate")].isApprox(at(0.5, 0.1, 1.5)))
      << "a fixed joint that TF does not tell is the URDF's";
  history_.add_static_transform("base", "plate", at(0.6, 0.1, 1.5));
  ask(13 * ms, options);
  EXPECT_TRUE(answer_.T_root_link[*robot_.find_link("plate")].isApprox(at(0.6, 0.1, 1.5)))
      << "what it tells is what is";
}

TEST_F(PoseLookupTest, ByBothWhereTheyAgree) {
  const PoseOptions options{.source = PoseSource::both};
  add_joint(10 * ms, 0.1);
  expect_fault(ask(10 * ms, options), FrameStatus::missing_transform, "'slab'");
  add_slab(10 * ms, 0.1049);
  ASSERT_EQ(ask(10 * ms, options).status, FrameStatus::ok);
  EXPECT_TRUE(answer_.T_root_link.empty()) << "the links' poses follow from the joints";
  add_slab(10 * ms, 0.1062);
  expect_fault(ask(10 * ms, options), FrameStatus::poses_disagree,
               "'slab' 6.2 mm apart, more than 5 mm");
}

TEST(FloatingBase, ItsPoseInTfIsNamed) {
  const Robot robot = parse(robot_xml(link_xml("world") + link_xml("base", box_xml("1 1 1")) +
                                      joint_xml("float", "floating", "world", "base")));
  PoseHistory history(robot);
  expect_fault(look_up(robot, history, 10 * ms), FrameStatus::missing_joints, "never seen");
  history.add_transform(10 * ms, "world", "base", at(0, 0, 1));
  expect_fault(look_up(robot, history, 10 * ms), FrameStatus::missing_joints, "set poses to tf");
  EXPECT_EQ(look_up(robot, history, 10 * ms, {.source = PoseSource::transforms}).status,
            FrameStatus::ok);
}

/// Nothing of the link `frame` is drawn.
class BoxAndFrame : public testing::Test {
 protected:
  Robot robot_ = parse(robot_xml(link_xml("base") + link_xml("box", box_xml("1 1 1")) +
                                 link_xml("frame") + joint_xml("a", "prismatic", "base", "box") +
                                 joint_xml("b", "prismatic", "box", "frame")));
  const std::vector<std::size_t> frame_ = {*robot_.find_link("frame")};
};

TEST_F(BoxAndFrame, WhatMovesNothingDrawnMayBeMissing) {
  const std::string a[] = {"a"}, b[] = {"b"};
  const double some[] = {0.1};
  PoseHistory with_a(robot_), with_b(robot_);
  with_a.add_joints(10 * ms, a, some);
  with_b.add_joints(10 * ms, b, some);
  const RobotPose by_a = look_up(robot_, with_a, 10 * ms);
  expect_uncertain(by_a, frame_, "joint 'b'");
  EXPECT_EQ(by_a.positions, (std::vector<double>{0.1, 0.0}));
  expect_fault(look_up(robot_, with_b, 10 * ms), FrameStatus::missing_joints, "joint 'a'");

  const PoseOptions options{.source = PoseSource::transforms};
  PoseHistory with_box(robot_), with_frame(robot_);
  with_box.add_transform(10 * ms, "base", "box", at(0.1, 0, 0));
  with_frame.add_transform(10 * ms, "box", "frame", at(0.1, 0, 0));
  expect_uncertain(look_up(robot_, with_box, 10 * ms, options), frame_, "'frame'");
  expect_fault(look_up(robot_, with_frame, 10 * ms, options), FrameStatus::missing_transform,
               "'box'");
}

TEST_F(BoxAndFrame, JointsThatMoveNothingDrawnMayBeDisputed) {
  PoseHistory history(robot_);
  const std::string names[] = {"a", "b"};
  for (std::int64_t t = 10; t <= 300; t += 10) {
    const double driven[] = {0.1, 0.7}, dragged[] = {0.1, 0.0};
    history.add_joints(t * ms, names, driven, "driver");
    history.add_joints((t + 2) * ms, names, dragged, "sliders");
  }
  const RobotPose answer = look_up(robot_, history, 205 * ms);
  expect_uncertain(answer, frame_, "joint 'b' is at 0.7 by driver");
  EXPECT_EQ(answer.positions.size(), 2U);
  EXPECT_EQ(look_up(robot_, history, 205 * ms, {.camera_parent = "frame"}).status,
            FrameStatus::poses_disagree);
}

/// Three boxes one after another, each on a joint of its own.
TEST(ThreeBoxes, OnlyWhatAnUnknownJointMovesIsUncertain) {
  std::string xml = link_xml("l0");
  for (const char* const i : {"1", "2", "3"})
    xml += link_xml("l" + std::string(i), box_xml("1 1 1")) +
           joint_xml("j" + std::string(i), "continuous", "l" + std::to_string(*i - '1'),
                     "l" + std::string(i));
  const Robot robot = parse(robot_xml(xml));
  const double position[] = {0.2};
  const std::vector<std::vector<std::size_t>> below{{1, 2, 3}, {2, 3}, {3}};
  for (std::size_t lacking = 0; lacking < 3; ++lacking) {
    PoseHistory history(robot);
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == lacking) continue;
      history.add_joints(10 * ms, robot.variables().subspan(i, 1), position);
      history.add_transform(10 * ms, robot.links()[i], robot.links()[i + 1],
                            Isometry3d::Identity());
    }
    for (const PoseSource source : {PoseSource::joints, PoseSource::transforms}) {
      const RobotPose answer = look_up(robot, history, 10 * ms, {.source = source});
      expect_uncertain(
          answer, below[lacking],
          (source == PoseSource::joints ? "'j" : "'l") + std::to_string(lacking + 1) + "'");
      EXPECT_TRUE(answer.positions.empty()) << "not all are known";
      EXPECT_EQ(answer.T_root_link.size(), 4U);
      const PoseOptions on_last{.source = source, .camera_parent = "l3"};
      EXPECT_FALSE(has_pose(look_up(robot, history, 10 * ms, on_last).status))
          << "it carries the camera";
    }
  }
  PoseHistory none(robot);
  none.add_joints(10 * ms, robot.variables().first(1), position);
  expect_fault(look_up(robot, none, 500 * ms), FrameStatus::missing_joints, "'j2'");
}

TEST_F(PoseLookupTest, OfTheCameraInTF) {
  const PoseOptions options{.camera_parent = "slab", .camera_frame = "optical"};
  add_joint(10 * ms, 0.0);
  expect_fault(ask(10 * ms, options), FrameStatus::missing_transform, "'optical'");
  add_slab(10 * ms, 0.0);
  history_.add_static_transform("slab", "housing", at(0.1, 0, 0));
  history_.add_static_transform("housing", "optical", at(0, 0.2, 0));
  ASSERT_EQ(ask(10 * ms, options).status, FrameStatus::ok);
  EXPECT_TRUE(answer_.T_parent_camera->isApprox(at(0.1, 0.2, 0)));
  add_joint(12 * ms, 0.0);
  EXPECT_EQ(ask(11 * ms, options).status, FrameStatus::ok) << "static frames have no age";
  EXPECT_EQ(answer_.age, ms);

  const PoseOptions at_root{.camera_parent = "", .camera_frame = "optical"};
  expect_fault(ask(11 * ms, at_root), FrameStatus::stale_transform, "'slab' in 'base'");
  add_slab(12 * ms, 0.2);
  ASSERT_EQ(ask(11 * ms, at_root).status, FrameStatus::ok);
  EXPECT_TRUE(answer_.T_parent_camera->isApprox(at(0.1, 0.2, 1.1)));
}

TEST_F(PoseLookupTest, StatesWithoutAStampAreRefused) {
  add_joint(0, 0.1);
  add_joint(-7, 0.1);
  add_slab(0, 0.1);
  EXPECT_EQ(history_.joint_states_without_stamp(), 2U);
  EXPECT_EQ(history_.transforms().count(TransformInsert::no_stamp), 1U);
  EXPECT_EQ(ask(0, {}).status, FrameStatus::missing_joints);
}

TEST_F(PoseLookupTest, AJumpOfTheClockForgetsWhatWasBefore) {
  history_.add_static_transform("base", "optical", at(1, 0, 0));
  add_joint(5000 * ms, 0.5);
  add_slab(5000 * ms, 0.5);
  add_joint(4000 * ms, 0.4);
  EXPECT_EQ(history_.clock_jumps(), 0U) << "late by a second";
  const auto epoch = history_.epoch();
  add_joint(4000 * ms - 1, 0.1);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  EXPECT_NE(history_.epoch(), epoch);
  EXPECT_TRUE(holds(history_.last_jump(), {"1000 ms", "joint states"}));
  EXPECT_EQ(ask(5000 * ms, {}).status, FrameStatus::stale_joints) << "not of the new time";
  EXPECT_EQ(ask(4000 * ms - 1, {}).status, FrameStatus::ok);
  EXPECT_EQ(ask(5000 * ms, {.source = PoseSource::transforms}).status,
            FrameStatus::missing_transform);
  EXPECT_TRUE(history_.transforms().knows("optical"));
  add_slab(9000 * ms, 0.0);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  add_slab(100 * ms, 0.0);
  EXPECT_EQ(history_.clock_jumps(), 2U);
  EXPECT_TRUE(holds(history_.last_jump(), "transforms"));
}

}  // namespace
}  // namespace penumbra::test
