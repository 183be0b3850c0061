// SPDX-License-Identifier: Apache-2.0
#include "slab_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/poses/pose_lookup.hpp>

namespace penumbra::test {
namespace {

constexpr double rounding = 1e-12;  // metres

Eigen::Isometry3d shift(double x, double y, double z) {
  return Eigen::Translation3d(x, y, z) * Eigen::Isometry3d::Identity();
}

class PoseLookupTest : public testing::Test {
 protected:
  void add_joint(std::int64_t stamp, double slide) {
    const std::string names[] = {"slide"};
    const double positions[] = {slide};
    history_.add_joints(stamp, names, positions);
  }

  /// As robot_state_publisher tells it.
  void add_slab(std::int64_t stamp, double slide, const std::string& prefix = "") {
    history_.add_transform(stamp, prefix + "base", prefix + "slab", shift(0, 0, 1 + slide));
  }

  const RobotPose& at(std::int64_t stamp, const PoseOptions& options) {
    PoseLookup lookup(robot_, options);
    lookup.at(history_, stamp, answer_);
    EXPECT_EQ(answer_.message.empty(), answer_.status == FrameStatus::ok) << answer_.message;
    return answer_;
  }

  void expect(FrameStatus status, const std::string& names) {
    EXPECT_EQ(answer_.status, status);
    EXPECT_NE(answer_.message.find(names), std::string::npos) << answer_.message;
  }

  Robot robot_ = slab_robot();
  PoseHistory history_{robot_};
  RobotPose answer_;
};

TEST_F(PoseLookupTest, ByJoints) {
  at(5 * ms, {});
  expect(FrameStatus::missing_joints, "'slide': never seen");
  add_joint(10 * ms, 0.1);
  at(15 * ms, {});
  expect(FrameStatus::stale_joints, "'slide'");
  add_joint(20 * ms, 0.12);
  EXPECT_EQ(at(15 * ms, {}).status, FrameStatus::ok);
  EXPECT_NEAR(answer_.positions[0], 0.11, rounding);
  EXPECT_EQ(answer_.age, 5 * ms);
  EXPECT_FALSE(answer_.T_parent_camera);
  add_joint(30 * ms, 0.9);
  at(25 * ms, {});
  expect(FrameStatus::stale_joints, "'slide': jumps");
}

TEST_F(PoseLookupTest, ByTransforms) {
  const PoseOptions options{.source = PoseSource::transforms};
  add_joint(10 * ms, 0.1);
  at(10 * ms, options);
  expect(FrameStatus::missing_transform, "'slab'");
  add_slab(10 * ms, 0.1);
  EXPECT_EQ(at(10 * ms, options).status, FrameStatus::ok);
  at(13 * ms, options);
  expect(FrameStatus::stale_transform, "'slab' in 'base'");
  add_slab(20 * ms, 0.2);
  ASSERT_EQ(at(13 * ms, options).status, FrameStatus::ok);
  EXPECT_EQ(answer_.age, 7 * ms);
  ASSERT_EQ(answer_.T_root_link.size(), 3U);
  EXPECT_TRUE(answer_.T_root_link[*robot_.find_link("slab")].isApprox(shift(0, 0, 1.13), rounding));
  EXPECT_TRUE(answer_.T_root_link[*robot_.find_link("plate")].isApprox(shift(0.5, 0.1, 1.5)))
      << "a fixed joint that TF does not tell is the URDF's";
  history_.add_static_transform("base", "plate", shift(0.6, 0.1, 1.5));
  at(13 * ms, options);
  EXPECT_TRUE(answer_.T_root_link[*robot_.find_link("plate")].isApprox(shift(0.6, 0.1, 1.5)))
      << "what it tells is what is";
}

TEST_F(PoseLookupTest, ByBothWhereTheyAgree) {
  const PoseOptions options{.source = PoseSource::both};
  add_joint(10 * ms, 0.1);
  at(10 * ms, options);
  expect(FrameStatus::missing_transform, "'slab'");
  add_slab(10 * ms, 0.1049);
  ASSERT_EQ(at(10 * ms, options).status, FrameStatus::ok);
  EXPECT_TRUE(answer_.T_root_link.empty()) << "the links' poses follow from the joints";
  add_slab(10 * ms, 0.1062);
  at(10 * ms, options);
  expect(FrameStatus::poses_disagree, "'slab' 6.2 mm apart, more than 5 mm");
}

/// Nothing of the link `frame` is drawn.
Robot box_and_frame() {
  return Robot::parse(
      "<robot name=\"r\"><link name=\"base\"/><link name=\"box\"><collision><geometry>"
      "<box size=\"1 1 1\"/></geometry></collision></link><link name=\"frame\"/>"
      "<joint name=\"a\" type=\"prismatic\"><parent link=\"base\"/><child link=\"box\"/></joint>"
      "<joint name=\"b\" type=\"prismatic\"><parent link=\"box\"/><child link=\"frame\"/></joint>"
      "</robot>",
      ".");
}

TEST_F(PoseLookupTest, WhatMovesNothingDrawnMayBeMissing) {
  const Robot robot = box_and_frame();
  const std::vector<std::size_t> frame = {*robot.find_link("frame")};
  const std::string a[] = {"a"}, b[] = {"b"};
  const double some[] = {0.1};
  {
    PoseHistory history(robot);
    history.add_joints(10 * ms, a, some);
    PoseLookup lookup(robot, {});
    lookup.at(history, 10 * ms, answer_);
    EXPECT_EQ(answer_.status, FrameStatus::ok) << answer_.message;
    EXPECT_EQ(answer_.uncertain_links, frame);
    EXPECT_NE(answer_.uncertain_reason.find("joint 'b': never seen"), std::string::npos)
        << answer_.uncertain_reason;
    EXPECT_EQ(answer_.positions, (std::vector<double>{0.1, 0.0}));
    PoseHistory other(robot);
    other.add_joints(10 * ms, b, some);
    lookup.at(other, 10 * ms, answer_);
    expect(FrameStatus::missing_joints, "joint 'a': never seen");
  }
  PoseLookup lookup(robot, {.source = PoseSource::transforms});
  PoseHistory history(robot);
  history.add_transform(10 * ms, "base", "box", shift(0.1, 0, 0));
  lookup.at(history, 10 * ms, answer_);
  EXPECT_EQ(answer_.status, FrameStatus::ok) << answer_.message;
  EXPECT_EQ(answer_.uncertain_links, frame);
  EXPECT_NE(answer_.uncertain_reason.find("'frame'"), std::string::npos)
      << answer_.uncertain_reason;
  PoseHistory other(robot);
  other.add_transform(10 * ms, "box", "frame", shift(0.1, 0, 0));
  lookup.at(other, 10 * ms, answer_);
  expect(FrameStatus::missing_transform, "'box'");
}

TEST_F(PoseLookupTest, JointsThatMoveNothingDrawnMayBeDisputed) {
  const Robot robot = box_and_frame();
  PoseHistory history(robot);
  const std::string names[] = {"a", "b"};
  for (std::int64_t t = 10; t <= 300; t += 10) {
    const double driven[] = {0.1, 0.7}, dragged[] = {0.1, 0.0};
    history.add_joints(t * ms, names, driven, "driver");
    history.add_joints((t + 2) * ms, names, dragged, "sliders");
  }
  PoseLookup lookup(robot, {});
  lookup.at(history, 205 * ms, answer_);
  EXPECT_EQ(answer_.status, FrameStatus::ok) << answer_.message;
  EXPECT_EQ(answer_.positions.size(), 2U);
  EXPECT_EQ(answer_.uncertain_links, (std::vector<std::size_t>{*robot.find_link("frame")}));
  EXPECT_NE(answer_.uncertain_reason.find("joint 'b' is at 0.7 by driver"), std::string::npos)
      << answer_.uncertain_reason;
  PoseLookup by_camera(robot, {.camera_parent = "frame"});
  by_camera.at(history, 205 * ms, answer_);
  EXPECT_EQ(answer_.status, FrameStatus::poses_disagree);
}

/// Three boxes one after another, each on a joint of its own.
Robot three_boxes() {
  std::string urdf = "<robot name=\"r\"><link name=\"l0\"/>";
  for (const std::string i : {"1", "2", "3"})
    urdf += "<link name=\"l" + i +
            "\"><collision><geometry><box size=\"1 1 1\"/></geometry>"
            "</collision></link><joint name=\"j" +
            i + "\" type=\"continuous\"><parent link=\"l" + std::to_string(i[0] - '1') +
            "\"/><child link=\"l" + i + "\"/></joint>";
  return Robot::parse(urdf + "</robot>", ".");
}

/// States and transforms of all joints but one.
struct WithoutOne {
  explicit WithoutOne(const Robot& robot, std::size_t lacking) : history(robot) {
    const double position[] = {0.2};
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == lacking) continue;
      history.add_joints(10 * ms, robot.variables().subspan(i, 1), position);
      history.add_transform(10 * ms, robot.links()[i], robot.links()[i + 1],
                            Eigen::Isometry3d::Identity());
    }
  }
  PoseHistory history;
};

TEST_F(PoseLookupTest, OnlyWhatAnUnknownJointMovesIsUncertain) {
  const Robot robot = three_boxes();
  using Links = std::vector<std::size_t>;
  const std::vector<Links> below{{1, 2, 3}, {2, 3}, {3}};
  for (std::size_t lacking = 0; lacking < 3; ++lacking)
    for (const PoseSource source : {PoseSource::joints, PoseSource::transforms}) {
      const WithoutOne known(robot, lacking);
      PoseLookup lookup(robot, {.source = source});
      lookup.at(known.history, 10 * ms, answer_);
      EXPECT_EQ(answer_.status, FrameStatus::ok) << answer_.message;
      EXPECT_EQ(answer_.uncertain_links, below[lacking]);
      const std::string name =
          (source == PoseSource::joints ? "'j" : "'l") + std::to_string(lacking + 1) + "'";
      EXPECT_NE(answer_.uncertain_reason.find(name), std::string::npos) << answer_.uncertain_reason;
      EXPECT_TRUE(answer_.positions.empty()) << "not all are known";
      EXPECT_EQ(answer_.T_root_link.size(), 4U);
      PoseLookup on_last(robot, {.source = source, .camera_parent = "l3"});
      on_last.at(known.history, 10 * ms, answer_);
      EXPECT_FALSE(has_pose(answer_.status)) << "it carries the camera";
    }
  const double position[] = {0.2};
  PoseHistory none(robot);
  none.add_joints(10 * ms, robot.variables().first(1), position);
  PoseLookup lookup(robot, {});
  lookup.at(none, 500 * ms, answer_);
  expect(FrameStatus::missing_joints, "'j2'");
}

TEST_F(PoseLookupTest, OfTheCameraInTF) {
  const PoseOptions options{.camera_parent = "slab", .camera_frame = "optical"};
  add_joint(10 * ms, 0.0);
  at(10 * ms, options);
  expect(FrameStatus::missing_transform, "'optical'");
  add_slab(10 * ms, 0.0);
  history_.add_static_transform("slab", "housing", shift(0.1, 0, 0));
  history_.add_static_transform("housing", "optical", shift(0, 0.2, 0));
  ASSERT_EQ(at(10 * ms, options).status, FrameStatus::ok);
  EXPECT_TRUE(answer_.T_parent_camera->isApprox(shift(0.1, 0.2, 0)));
  add_joint(12 * ms, 0.0);
  EXPECT_EQ(at(11 * ms, options).status, FrameStatus::ok) << "static frames have no age";
  EXPECT_EQ(answer_.age, ms);

  const PoseOptions at_root{.camera_parent = "", .camera_frame = "optical"};
  at(11 * ms, at_root);
  expect(FrameStatus::stale_transform, "'slab' in 'base'");
  add_slab(12 * ms, 0.2);
  ASSERT_EQ(at(11 * ms, at_root).status, FrameStatus::ok);
  EXPECT_TRUE(answer_.T_parent_camera->isApprox(shift(0.1, 0.2, 1.1)));
}

class PoseHistoryTest : public PoseLookupTest {};

TEST_F(PoseHistoryTest, StatesWithoutAStampAreRefused) {
  add_joint(0, 0.1);
  add_joint(-7, 0.1);
  add_slab(0, 0.1);
  EXPECT_EQ(history_.joint_states_without_stamp(), 2U);
  EXPECT_EQ(history_.transforms().count(TransformInsert::no_stamp), 1U);
  EXPECT_EQ(at(0, {}).status, FrameStatus::missing_joints);
}

TEST_F(PoseHistoryTest, AJumpOfTheClockForgetsWhatWasBefore) {
  history_.add_static_transform("base", "optical", shift(1, 0, 0));
  add_joint(5000 * ms, 0.5);
  add_slab(5000 * ms, 0.5);
  add_joint(4000 * ms, 0.4);
  EXPECT_EQ(history_.clock_jumps(), 0U) << "late by a second";
  EXPECT_EQ(history_.last_jump(), "");
  const auto epoch = history_.epoch();
  add_joint(4000 * ms - 1, 0.1);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  EXPECT_NE(history_.epoch(), epoch);
  EXPECT_NE(history_.last_jump().find("1000 ms"), std::string::npos) << history_.last_jump();
  EXPECT_NE(history_.last_jump().find("joint states"), std::string::npos);
  EXPECT_EQ(at(5000 * ms, {}).status, FrameStatus::stale_joints) << "not of the new time";
  EXPECT_EQ(at(4000 * ms - 1, {}).status, FrameStatus::ok);
  EXPECT_EQ(at(5000 * ms, {.source = PoseSource::transforms}).status,
            FrameStatus::missing_transform);
  EXPECT_TRUE(history_.transforms().knows("optical"));
  add_slab(9000 * ms, 0.0);
  EXPECT_EQ(history_.clock_jumps(), 1U);
  add_slab(100 * ms, 0.0);
  EXPECT_EQ(history_.clock_jumps(), 2U);
  EXPECT_NE(history_.last_jump().find("transforms"), std::string::npos);
}

}  // namespace
}  // namespace penumbra::test
