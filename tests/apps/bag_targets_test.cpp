// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags: frames with other names than the robot's links, targets, and what MoveIt
// attaches to the robot, against the same bodies in a recording.
#include "../support/test.hpp"
#include "fixtures.hpp"

#include <io/ros/cdr_writer.hpp>
#include <io/ros/moveit_messages.hpp>

namespace penumbra::test {
namespace {

using BagNamesTest = BagTest;

// A bag recorded next to a node has its results, too.
TEST_F(BagNamesTest, ResultsOfPenumbraAreNoInput) {
  for (const char* const result : {"filtered_depth", "virtual_depth"})
    bag_.copy(depth_topic, std::string("/cell/penumbra/") + result);
  bag_.copy(info_topic, "/cell/penumbra/camera_info");
  expect_recorded();
}

TEST_F(BagNamesTest, ALeadingSlashIsNothing) {
  bag_.add_board_frames();
  bag_.rename_frames([](const std::string& frame) { return "/" + frame; });
  for (const char* const poses : {"joints", "tf", "both"}) expect_recorded({"--poses", poses});
  bag_.edit<io::ImageMessage>([](auto& image) { image.header.frame_id = "/optical"; });
  for (const Words& options : {Words{}, {"--camera-frame", "/optical"}}) expect_recorded(options);
}

TEST_F(BagNamesTest, FramesOfARobotMayHaveAPrefix) {
  bag_.add_board_frames();
  bag_.rename_frames([](const std::string& frame) {
    return frame == "base" || frame == "board" ? "left/" + frame : frame;
  });
  expect_refused(run({"--poses", "tf"}), {"--frame-prefix left/"});
  for (const char* const prefix : {"left/", "/left/"})
    for (const char* const poses : {"joints", "tf", "both"})
      expect_has(expect_recorded({"--poses", poses, "--frame-prefix", prefix}).out,
                 {"'optical'", "'base'"});
  EXPECT_EQ(run({"--poses", "tf", "--frame-prefix", "right/"}).status, 2);
}

/// Targets of messages that come 0.3 s after frame 1, when the next frame is there.
class BagTargets : public BagTest {
 protected:
  static constexpr std::int64_t stamp = tiny_stamp(1), arrival = stamp + 300'000'000;

  /// A detection of vision_msgs: all fields of its BoundingBox2D or BoundingBox3D.
  struct Detection {
    std::string id;
    std::vector<double> box;
  };
  /// Of a Detection2DArray, pixels.
  static Detection square(const std::string& id, double u, double v, double size) {
    return {id, {u, v, 0.0, size, size}};
  }
  /// Of a Detection3DArray: 8 cm wide.
  static Detection cube(const std::string& id, double x, double y, double z) {
    return {id, {x, y, z, 0.0, 0.0, 0.0, 1.0, 0.08, 0.08, 0.08}};
  }
  /// Adds a Detection2DArray or Detection3DArray, by the fields of their definitions.
  void add(const std::string& topic, const std::string& type, const std::string& frame,
           const std::vector<Detection>& detections) {
    bag_.messages.push_back({topic, type, arrival, {}});
    TinyBag::Message& message = bag_.messages.back();
    io::CdrWriter writer(message.data);
    const auto write_header = [&] {
      writer.write(static_cast<std::int32_t>(stamp / 1'000'000'000));
      writer.write(static_cast<std::uint32_t>(stamp % 1'000'000'000));
      writer.write_string(frame);
    };
    write_header();
    writer.write_count(detections.size());
    for (const Detection& detection : detections) {
      write_header();
      writer.write_count(0);  // hypotheses
      for (const double value : detection.box) writer.write(value);
      writer.write_string(detection.id);
    }
  }
  void add_pose(const std::string& topic, const std::string& frame) {
    bag_.add(
        topic, arrival,
        io::PoseStampedMessage{{stamp, frame}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2))});
  }

  /// Runs and returns the verdicts of frame 1 by the targets' names. `reason`: why the target
  /// `unknown` is so.
  std::map<std::string, std::string> verdicts(const Words& topics, const std::string& unknown,
                                              const Words& reason, Words options = {}) {
    for (const std::string& topic : topics)
      options.insert(options.end(), {"--target-topic", topic});
    out_ = succeed(run(options)).out;
    std::map<std::string, std::string> all;
    const Json json = report();
    EXPECT_TRUE(json["frames"][0]["targets"].empty() && json["frames"][2]["targets"].empty());
    for (const Json& target : json["frames"][1]["targets"]) {
      all[target["name"]] = target["verdict"];
      if (target["name"] == unknown) expect_has(std::string(target["reason"]), reason);
    }
    return all;
  }

  std::string out_;
};

TEST_F(BagTargets, OfADetectorIn3DAreJudgedInFramesOfLinksAndTheCamera) {
  for (const auto& [frame, topic] : {std::pair("optical", "/of_camera"),
                                     {"left/base", "/of_link"},
                                     {"/left/base", "/of_slash"},
                                     {"base", "/of_other"}})
    add(topic, "vision_msgs/msg/Detection3DArray", frame,
        {cube("box 0", 0.15, 0.05, 2.0),   // behind the board
         cube("box 1", 0.6, 0.4, 3.03)});  // before the wall
  bag_.rename_frames(
      [](const std::string& frame) { return frame == "base" ? "left/" + frame : frame; });
  auto all = verdicts({"/of_camera", "/of_link", "/of_slash", "/of_other"}, "/of_other/box 0",
                      {"'base'"}, {"--frame-prefix", "left/"});
  for (const std::string topic : {"/of_camera", "/of_link", "/of_slash"}) {
    EXPECT_EQ(all[topic + "/box 0"], "hidden") << topic;
    EXPECT_EQ(all[topic + "/box 1"], "visible") << topic;
  }
  EXPECT_EQ(all["/of_other/box 0"], "unknown");
}

TEST_F(BagTargets, AreJudgedOnTheFrameOfTheirStamp) {
  // On the object before the board, on the board, on the wall.
  add("/detections", "vision_msgs/msg/Detection2DArray", "optical",
      {square("object", 28, 24, 6), square("board", 22, 26, 3), square("wall", 5, 5, 4)});
  bag_.add("/wrist", arrival,
           io::KeypointsMessage{{stamp, "optical"}, {{"left", 28, 24, 0.9, 0.5}}});
  add_pose("/far", "map");
  add_pose("/goal", "base");
  EXPECT_EQ(verdicts({"/detections", "/wrist", "/goal", "/far"}, "/far", {"'map' is neither"}),
            (std::map<std::string, std::string>{{"/detections/object", "unknown"},
                                                {"/detections/board", "hidden"},
                                                {"/detections/wall", "visible"},
                                                {"/wrist/left", "visible"},
                                                {"/goal", "hidden"},
                                                {"/far", "unknown"}}))
      << "an object that a detector first sees beside the robot may be larger than what it sees";
  expect_has(out_, {"/wrist", "penumbra_msgs/msg/Keypoints"});
}

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
  /// Expects labels as of part() from frame 1 on, or before frame `end`.
  void expect_part_from_1_on(int end = 3) {
    EXPECT_EQ(frames_with_part(), end == 3 ? "011" : "010");
    EXPECT_EQ(statuses()[1], "ok") << message(1);
    edit("recording.yaml", "robot:",
         "attached: [{name: part, link: board, box: [0.1, 0.1, 0.1], "
         "pose: [0.3, -0.2, 0, 0, 0, 0, 1], frames: [1, " +
             std::to_string(end) + "]}]\nrobot:");
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
  expect_part_from_1_on(2);
}

TEST_F(BagAttachedTest, PlanningScenesAddAndReplace) {
  io::PlanningSceneMessage scene;
  scene.robot_state.is_diff = true;
  scene.robot_state.attached = {part(tiny_stamp(1) - 10 * ms)};
  bag_.add(scene_topic, tiny_stamp(1), scene);
  EXPECT_EQ(frames_with_part(), "011");
  // A change of the world alone.
  bag_.add(scene_topic, tiny_stamp(2) - 20 * ms, io::PlanningSceneMessage{});
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
  using Object = io::CollisionObjectMessage;
  const std::vector<std::pair<std::string, std::function<void(Object&)>>> wrong = {
      {"shape is not in the message",
       [](Object& it) { it.primitives.clear(), it.primitive_poses.clear(); }},
      {"only boxes", [](Object& it) { it.primitives[0].type = io::SolidPrimitiveMessage::cone; }},
      {"larger than 10 m", [](Object& it) { it.primitives[0].dimensions[1] = 11; }},
      {"'map'", [](Object& it) { it.header.frame_id = "map"; }},
      {"not a rigid transform", [](Object& it) { it.pose.orientation.setZero(); }},
      {"adding and removing", [](Object& it) { it.operation = Object::move; }},
      {"a vertex that the mesh lacks",
       [](Object& it) {
         it.meshes = {{.triangles = {{{0, 1, 7}}}, .vertices = {{}, {1, 0, 0}, {0, 1, 0}}}};
         it.mesh_poses = {pose({0, 0, 0})};
       }},
      {"no link 'gripper'", [](Object& it) { it.header.frame_id = "gripper"; }}};
  for (const auto& [why, change] : wrong) {
    io::AttachedObjectMessage attached = part(tiny_stamp(1) - 10 * ms);
    change(attached.object);
    if (attached.object.header.frame_id != "map")
      attached.link_name = attached.object.header.frame_id;
    bag_ = without;
    bag_.add(attached_topic, tiny_stamp(1), attached);
    bag_.sort();
    expect_has(succeed(run()).err, {"'part'", why});
    EXPECT_EQ(statuses(), (Words{"ok", "missing_link", "missing_link"})) << message(1);
    expect_has(message(1), {"'part'", why});
  }
}

}  // namespace
}  // namespace penumbra::test
