// SPDX-License-Identifier: Apache-2.0
// What MoveIt attaches to the robot of a bag, against the same bodies in a recording.
#include "fixtures.hpp"

#include <algorithm>
#include <functional>

#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t ms = 1'000'000;
const std::string attached_topic = "/attached_collision_object";
const std::string scene_topic = "/monitored_planning_scene";

class BagAttachedTest : public BagTest {
 protected:
  /// A box in the upper right corner of the image, where the wall is.
  static io::AttachedObjectMessage part(std::int64_t stamp) {
    io::AttachedObjectMessage message{.link_name = "board"};
    message.object.header = {stamp, "board"};
    message.object.id = "part";
    message.object.pose = pose({0.3, -0.2, 0.0});
    message.object.primitives = {
        {.type = io::SolidPrimitiveMessage::box, .dimensions = {0.1, 0.1, 0.1}}};
    message.object.primitive_poses = {pose({0, 0, 0})};
    return message;
  }
  static io::AttachedObjectMessage removal(std::int64_t stamp, const std::string& id) {
    io::AttachedObjectMessage message;
    message.object.header.stamp = stamp;
    message.object.id = id;
    message.object.operation = io::CollisionObjectMessage::remove;
    return message;
  }
  static io::LoosePose pose(const Eigen::Vector3d& at) { return {at, {0, 0, 0, 1}}; }

  /// Which frames have the part: "010" for the second one.
  std::string frames_with_part() {
    sort();
    const Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::string frames;
    const Json said = report();
    for (const Json& frame : said["frames"]) frames += frame["attached"].empty() ? '0' : '1';
    return frames;
  }
  void sort() {
    std::stable_sort(bag_.messages.begin(), bag_.messages.end(),
                     [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  }
};

TEST_F(BagAttachedTest, AnObjectIsDrawnFromItsStampOn) {
  // The message comes 20 ms after its stamp, as images do 30 ms after theirs.
  bag_.add(attached_topic, tiny_stamp(1) + 20 * ms, part(tiny_stamp(1) - 10 * ms));
  bag_.add(attached_topic, tiny_stamp(2) + 20 * ms, removal(tiny_stamp(2) - 10 * ms, "part"));
  EXPECT_EQ(frames_with_part(), "010");
  write_file(path("recording.yaml"),
             read_file(path("recording.yaml")) +
                 "attached: [{name: part, link: board, box: [0.1, 0.1, 0.1], "
                 "pose: [0.3, -0.2, 0, 0, 0, 0, 1], frames: [1, 2]}]\n");
  expect_recorded_labels();
}

TEST_F(BagAttachedTest, StampsCountNotTheOrderOfMessages) {
  bag_.add(attached_topic, tiny_stamp(0), removal(tiny_stamp(2) - 10 * ms, ""));
  bag_.add(attached_topic, tiny_stamp(0) + 1, part(tiny_stamp(1) - 10 * ms));
  EXPECT_EQ(frames_with_part(), "011") << "a removal of all removes what was known";
  bag_.add(attached_topic, tiny_stamp(0) + 2, removal(tiny_stamp(2) - 10 * ms, "part"));
  EXPECT_EQ(frames_with_part(), "010");
}

TEST_F(BagAttachedTest, PlanningScenesAddAndReplace) {
  io::PlanningSceneMessage scene;
  scene.robot_state.is_diff = true;
  scene.robot_state.attached = {part(tiny_stamp(1) - 10 * ms)};
  bag_.add(scene_topic, tiny_stamp(1), scene);
  EXPECT_EQ(frames_with_part(), "011");
  io::PlanningSceneMessage of_world;  // a change of the world alone
  bag_.add(scene_topic, tiny_stamp(2) - 20 * ms, of_world);
  EXPECT_EQ(frames_with_part(), "011");
  io::PlanningSceneMessage whole;
  whole.robot_state.joints = {.header = {tiny_stamp(2) - 10 * ms, ""}, .names = {"slide"}};
  bag_.add(scene_topic, tiny_stamp(2) - 5 * ms, whole);
  EXPECT_EQ(frames_with_part(), "010");
}

/// Without a stamp an object is attached from the newest joint state on.
TEST_F(BagAttachedTest, WithoutAStampItHoldsFromNowOn) {
  bag_.add(attached_topic, tiny_stamp(1) - 100 * ms, part(0));
  EXPECT_EQ(frames_with_part(), "011");
}

TEST_F(BagAttachedTest, WhatCannotBeDrawnMakesFramesMissingLinks) {
  const TinyBag without = bag_;
  const auto expect_missing = [&](const std::function<void(io::AttachedObjectMessage&)>& change,
                                  const std::string& why) {
    io::AttachedObjectMessage attached = part(tiny_stamp(1) - 10 * ms);
    change(attached);
    bag_ = without;
    bag_.add(attached_topic, tiny_stamp(1), attached);
    sort();
    const Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_has(outcome.err, {why});
    EXPECT_EQ(status(0), "ok");
    EXPECT_EQ(status(1), "missing_link") << why;
    EXPECT_NE(BagTest::message(1).find("'part'"), std::string::npos);
  };
  expect_missing([](auto& m) { m.object.primitives.clear(), m.object.primitive_poses.clear(); },
                 "its shape is not in the message");
  expect_missing([](auto& m) { m.object.primitives[0].type = io::SolidPrimitiveMessage::cone; },
                 "only boxes");
  expect_missing([](auto& m) { m.object.primitives[0].dimensions[1] = -1; }, "is not drawn");
  expect_missing([](auto& m) { m.object.primitives[0].dimensions[1] = 11; }, "larger than 10 m");
  expect_missing([](auto& m) { m.object.header.frame_id = "base"; }, "not in its link");
  expect_missing([](auto& m) { m.object.pose.orientation.setZero(); }, "not a rigid transform");
  expect_missing([](auto& m) { m.object.operation = io::CollisionObjectMessage::move; },
                 "adding and removing");
  expect_missing(
      [](auto& m) {
        m.object.meshes = {{.triangles = {{{0, 1, 7}}}, .vertices = {{}, {1, 0, 0}, {0, 1, 0}}}};
        m.object.mesh_poses = {pose({0, 0, 0})};
      },
      "a vertex that the mesh lacks");
}

TEST_F(BagAttachedTest, ALinkThatTheRobotLacksIsToldByTheFrame) {
  io::AttachedObjectMessage attached = part(tiny_stamp(1) - 10 * ms);
  attached.link_name = attached.object.header.frame_id = "gripper";
  bag_.add(attached_topic, tiny_stamp(1), attached);
  sort();
  EXPECT_EQ(run().status, 0);
  EXPECT_EQ(status(1), "missing_link");
  EXPECT_NE(BagTest::message(1).find("no link 'gripper'"), std::string::npos)
      << BagTest::message(1);
}

}  // namespace
}  // namespace penumbra::test
