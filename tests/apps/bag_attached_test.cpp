// SPDX-License-Identifier: Apache-2.0
// What MoveIt attaches to the robot of a bag, against the same bodies in a recording.
#include "fixtures.hpp"

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
  /// As MoveIt's attachObject("part") publishes it: without shape and stamp.
  static io::AttachedObjectMessage named_part() {
    io::AttachedObjectMessage message{.link_name = "board"};
    message.object.id = "part";
    return message;
  }
  /// What MoveIt publishes then: everything, with the stamp of the robot's last motion.
  static io::PlanningSceneMessage scene_of(std::int64_t last_motion) {
    io::PlanningSceneMessage scene;
    scene.robot_state.joints = {.header = {last_motion, ""}, .names = {"slide"}};
    scene.robot_state.attached = {part(0)};
    return scene;
  }
  /// Expects labels as of part() from frame 1 on.
  void expect_part_from_1_on() {
    EXPECT_EQ(frames_with_part(), "011");
    EXPECT_EQ(statuses()[1], "ok") << message(1);
    edit_file(path("recording.yaml"), "robot:",
              "attached: [{name: part, link: board, box: [0.1, 0.1, 0.1], "
              "pose: [0.3, -0.2, 0, 0, 0, 0, 1], frames: [1, 3]}]\nrobot:");
    expect_recorded_labels();
  }
  static io::LoosePose pose(const Eigen::Vector3d& at) { return {at, {0, 0, 0, 1}}; }

  /// Which frames have the part: "010" for the second one.
  std::string frames_with_part() {
    bag_.sort();
    succeed(run());
    std::string frames;
    const Json said = report();
    for (const Json& frame : said["frames"]) frames += frame["attached"].empty() ? '0' : '1';
    return frames;
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
  io::PlanningSceneMessage whole = scene_of(tiny_stamp(2) - 10 * ms);
  whole.robot_state.attached.clear();
  bag_.add(scene_topic, tiny_stamp(2) - 5 * ms, whole);
  EXPECT_EQ(frames_with_part(), "010");
}

/// Without a stamp an object is attached from the newest joint state on.
TEST_F(BagAttachedTest, WithoutAStampItHoldsFromNowOn) {
  bag_.add(attached_topic, tiny_stamp(1) - 100 * ms, part(0));
  EXPECT_EQ(frames_with_part(), "011");
}

TEST_F(BagAttachedTest, AShapeReplacesItsAbsenceWhateverTheStamps) {
  bag_.add(attached_topic, tiny_stamp(1) - 100 * ms, named_part());
  bag_.add(scene_topic, tiny_stamp(1) - 50 * ms, scene_of(tiny_stamp(0) + 50 * ms));
  expect_part_from_1_on();
}

TEST_F(BagAttachedTest, AShapeStaysIfItIsNotRepeated) {
  bag_.add(scene_topic, tiny_stamp(1) - 100 * ms, scene_of(tiny_stamp(0) + 50 * ms));
  bag_.add(attached_topic, tiny_stamp(1) - 50 * ms, named_part());
  expect_part_from_1_on();
}

/// The world's objects have their poses in the planning frame. The last joint state before the
/// object is attached is 20 ms before the image.
const double board_then = 1.0 + tiny_speed * 0.38;  // z, metres

TEST_F(BagAttachedTest, AnObjectOfTheWorldHasItsShapeThere) {
  io::PlanningSceneMessage scene;
  scene.world.objects = {part(0).object};
  scene.world.objects[0].header.frame_id = "base";
  scene.world.objects[0].pose = pose({0.3, -0.2, board_then});
  // Fields between robot_state and world.
  scene.collisions = {.entry_names = {"a"}, .entry_values = {{.enabled = {1}}}};
  scene.paddings = {{.link_name = "board", .padding = 0.01}};
  scene.colors = {{.id = "part"}};
  bag_.add(scene_topic, tiny_stamp(0), scene);
  bag_.add(attached_topic, tiny_stamp(1) - 15 * ms, named_part());
  expect_part_from_1_on();
}

TEST_F(BagAttachedTest, WhatCannotBeDrawnMakesFramesMissingLinks) {
  const TinyBag without = bag_;
  const auto expect_missing = [&](const std::function<void(io::AttachedObjectMessage&)>& change,
                                  const Words& why) {
    io::AttachedObjectMessage attached = part(tiny_stamp(1) - 10 * ms);
    change(attached);
    bag_ = without;
    bag_.add(attached_topic, tiny_stamp(1), attached);
    bag_.sort();
    expect_has(succeed(run()).err, why);
    EXPECT_EQ(statuses(), (Words{"ok", "missing_link", "missing_link"})) << message(1);
    expect_has(message(1), why);
  };
  using Message = io::AttachedObjectMessage;
  expect_missing([](Message& m) { m.object.primitives.clear(), m.object.primitive_poses.clear(); },
                 {"'part'", "its shape is not in the message"});
  expect_missing([](Message& m) { m.object.primitives[0].type = io::SolidPrimitiveMessage::cone; },
                 {"'part'", "only boxes"});
  expect_missing([](Message& m) { m.object.primitives[0].dimensions[1] = 11; },
                 {"'part'", "larger than 10 m"});
  expect_missing([](Message& m) { m.object.header.frame_id = "map"; }, {"'part'", "'map'"});
  expect_missing([](Message& m) { m.object.pose.orientation.setZero(); },
                 {"'part'", "not a rigid transform"});
  expect_missing([](Message& m) { m.object.operation = io::CollisionObjectMessage::move; },
                 {"'part'", "adding and removing"});
  expect_missing(
      [](Message& m) {
        m.object.meshes = {{.triangles = {{{0, 1, 7}}}, .vertices = {{}, {1, 0, 0}, {0, 1, 0}}}};
        m.object.mesh_poses = {pose({0, 0, 0})};
      },
      {"'part'", "a vertex that the mesh lacks"});
  expect_missing([](Message& m) { m.link_name = m.object.header.frame_id = "gripper"; },
                 {"no link 'gripper'"});
}

}  // namespace
}  // namespace penumbra::test
