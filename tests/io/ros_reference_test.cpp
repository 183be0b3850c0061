// SPDX-License-Identifier: Apache-2.0
// Our definitions and payloads, read by Foxglove's library, and its definitions against ours.
#include "../support/node_scripts.hpp"
#include "files.hpp"
#include "ros_samples.hpp"

#include <nlohmann/json.hpp>

#include <io/assembly/attached_input.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

using Json = nlohmann::json;
using test::encoded;

Json answer(const std::string& arguments) {
  const auto told = test::run_script("ros_messages.mjs", arguments);
  EXPECT_EQ(told.status, 0) << told.errors;
  return Json::parse(told.output);
}

struct Exchange {
  test::TemporaryFolder folder;
  std::string list;
  int files = 0;

  void add(const std::string& type, const std::vector<std::byte>& payload) {
    const std::string name = std::to_string(files++);
    const auto definition = folder.write(name + ".msg", definition_of(type));
    const auto* first = reinterpret_cast<const char*>(payload.data());
    const auto file = folder.write(name + ".cdr", {first, payload.size()});
    list += type + " " + definition.string() + " " + file.string() + "\n";
  }

  /// The message in CDR, by Foxglove's library.
  std::vector<std::byte> encoded(const std::string& type, const Json& message) {
    const auto definition = folder.write("one.msg", definition_of(type));
    const auto file = folder.write("one.cdr", message.dump());
    const std::string one = type + " " + definition.string() + " " + file.string() + "\n";
    answer("encode " + folder.write("one", one).string());
    const std::string bytes = test::read_bytes(file);
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    return {first, first + bytes.size()};
  }

  Json answer_to(const std::string& task) {
    return answer(task + " " + folder.write("list", list).string());
  }
};

// What Foxglove's library reads of the samples, in the order of for_each_sample. $H is the header;
// $P and $Q are sample_pose() and its inverse.
constexpr const char* wanted_messages = R"([
{"header": $H, "height": 1, "width": 5, "encoding": "mono8", "is_bigendian": 0, "step": 5,
 "data": [1, 2, 250, 0, 7]},
{"header": $H, "format": "png", "data": [1, 2, 250, 0, 7]},
{"header": $H, "height": 480, "width": 640, "distortion_model": "plumb_bob",
 "d": [0.1, -0.2, 0.001, 0.002, 0.05], "k": [0, 1.5, 3, 4.5, 6, 7.5, 9, 10.5, 12],
 "r": [100, 99, 98, 97, 96, 95, 94, 93, 92],
 "p": [0.25, 1.25, 2.25, 3.25, 4.25, 5.25, 6.25, 7.25, 8.25, 9.25, 10.25, 11.25],
 "binning_x": 2, "binning_y": 4,
 "roi": {"x_offset": 1, "y_offset": 2, "height": 3, "width": 4, "do_rectify": true}},
{"header": $H, "name": ["elbow", "", "shoulder_pan"], "position": [0.5, -1.25, 3], "velocity": [],
 "effort": [7, 8]},
{"transforms": [
  {"header": $H, "child_frame_id": "tool", "transform": {"translation": $Pt, "rotation": $Pr}},
  {"header": {"stamp": {"sec": -1, "nanosec": 999999999}, "frame_id": "a"}, "child_frame_id": "",
   "transform": {"translation": $Qt, "rotation": $Qr}}]},
{"data": "<robot name=\"r\"/>"},
{"header": $H, "pose": {"position": $Pt, "orientation": $Pr}},
{"header": $H, "height": 1, "width": 1,
 "fields": [{"name": "x", "offset": 0, "datatype": 7, "count": 1},
            {"name": "intensity", "offset": 4, "datatype": 2, "count": 1}],
 "is_bigendian": false, "point_step": 5, "row_step": 5, "data": [1, 2, 250, 0, 7],
 "is_dense": true},
{"header": $H, "angle_min": -1.5, "angle_max": 1.5, "angle_increment": 1.5,
 "time_increment": 9.999999747378752e-05, "scan_time": 0.02500000037252903,
 "range_min": 0.10000000149011612, "range_max": 30, "ranges": [1, "NaN", 2],
 "intensities": [7, 8, 9]},
{"header": $H, "timebase": "1000000000", "point_num": 2, "lidar_id": 3, "rsvd": [4, 5, 6],
 "points": [
  {"offset_time": 0, "x": 1, "y": 2, "z": 3, "reflectivity": 10, "tag": 11, "line": 12},
  {"offset_time": 100, "x": 4, "y": 5, "z": 6, "reflectivity": 20, "tag": 21, "line": 22}]},
{"header": $H, "status": [
  {"level": 1, "name": "camera", "message": "late", "hardware_id": "d435",
   "values": [{"key": "age_ms", "value": "35.5"}, {"key": "drops", "value": "3"}]},
  {"level": 3, "name": "joints", "message": "none", "hardware_id": "", "values": []}]},
{"header": $H, "keypoints": [
  {"name": "left/wrist", "u": 12.5, "v": -3, "score": 0.75, "depth": 1.25},
  {"name": "nose", "u": 0, "v": 0, "score": 0, "depth": "NaN"}]},
{"header": $H, "root_frame": "base_link", "status": "stale_joints",
 "message": "elbow: 0.3 s old", "targets": [
  {"name": "part", "has_stamp": true, "stamp": {"sec": 5, "nanosec": 1}, "verdict": 2,
   "verdict_name": "partial", "reason": "", "judged": true, "covered": "5000000000",
   "inside": "120", "occluded_fraction": 0.25, "front_fraction": 0.5, "clear_fraction": 0.125,
   "unknown_fraction": 0.125, "hidden_by_other_fraction": 0, "measured_fraction": 0,
   "seen_past_fraction": 0,
   "blame": [{"link": "wrist_3", "fraction": 0.2}, {"link": "tool", "fraction": 0.05}],
   "point": {"x": 1, "y": 2, "z": 3}, "point_pixels": "77", "point_spread": 0.003, "source": 2,
   "age": 0.5, "pose": {"position": {"x": 4, "y": 5, "z": 6},
                        "orientation": {"x": "NaN", "y": "NaN", "z": "NaN", "w": "NaN"}},
   "sigma": 0.01, "forecast_seconds": 2, "hidden_in": 1.25, "hidden_for": "Infinity",
   "lost_in": 1.75, "hidden_by": "forearm", "forecast_reason": "", "estimate": 3},
  {"name": "wrist", "has_stamp": false, "stamp": {"sec": 0, "nanosec": 0}, "verdict": 0,
   "verdict_name": "unknown", "reason": "joint states are stale", "judged": false,
   "covered": "0", "inside": "0", "occluded_fraction": "NaN", "front_fraction": "NaN",
   "clear_fraction": "NaN", "unknown_fraction": "NaN", "hidden_by_other_fraction": 0,
   "measured_fraction": 0, "seen_past_fraction": 0, "blame": [], "point": $N,
   "point_pixels": "0", "point_spread": 0, "source": 0, "age": "Infinity",
   "pose": {"position": $N, "orientation": {"x": "NaN", "y": "NaN", "z": "NaN", "w": "NaN"}},
   "sigma": 0, "forecast_seconds": 0, "hidden_in": "NaN", "hidden_for": "NaN",
   "lost_in": "Infinity", "hidden_by": "", "forecast_reason": "", "estimate": 0}]},
{"header": $H, "targets": [
  {"name": "part", "verdict": 1, "verdict_name": "visible", "reason": "", "best": "left",
   "point": {"x": 1, "y": 2, "z": 3},
   "covariance": [1, 0.5, 0.25, 0.5, 2, 0.125, 0.25, 0.125, 3], "contradicting": [],
   "contradiction_distance": 0, "contradiction_chi_square": 0, "views": [
    {"camera": "left", "has_stamp": true, "stamp": {"sec": 5, "nanosec": 1}, "verdict": 1,
     "verdict_name": "visible", "reason": "", "visible_fraction": 0.75,
     "point": {"x": 1.5, "y": 2, "z": 3}, "distance": 0.5, "angle": 0.125},
    {"camera": "right", "has_stamp": false, "stamp": {"sec": 0, "nanosec": 0}, "verdict": 0,
     "verdict_name": "unknown", "reason": "no view of it within the window of time",
     "visible_fraction": 0, "point": $N, "distance": 0, "angle": 0}]},
  {"name": "tool", "verdict": 0, "verdict_name": "unknown",
   "reason": "cameras measure it at different places", "best": "", "point": $N,
   "covariance": ["NaN", "NaN", "NaN", "NaN", "NaN", "NaN", "NaN", "NaN", "NaN"],
   "contradicting": ["left", "right"], "contradiction_distance": 0.25,
   "contradiction_chi_square": 40, "views": []}]}
])";

Json wanted_json() {
  const auto translation = [](const Eigen::Isometry3d& pose) -> Json {
    const Eigen::Vector3d t = pose.translation();
    return {{"x", t.x()}, {"y", t.y()}, {"z", t.z()}};
  };
  const auto rotation = [](const Eigen::Isometry3d& pose) -> Json {
    const Eigen::Quaterniond q(pose.linear());
    return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
  };
  const Eigen::Isometry3d p = test::sample_pose(), q = p.inverse();
  std::string text = wanted_messages;
  for (const auto& [name, value] : std::map<std::string, std::string>{
           {"$H", R"({"stamp": {"sec": 1699999999, "nanosec": 987654321},
                      "frame_id": "camera/optical"})"},
           {"$N", R"({"x": "NaN", "y": "NaN", "z": "NaN"})"},
           {"$Pt", translation(p).dump()},
           {"$Pr", rotation(p).dump()},
           {"$Qt", translation(q).dump()},
           {"$Qr", rotation(q).dump()}})
    for (std::size_t at = 0; (at = text.find(name)) != std::string::npos;)
      text.replace(at, name.size(), value);
  return Json::parse(text);
}

TEST(RosReference, ReadsWhatWeWrite) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  Exchange exchange;
  test::for_each_sample([&](const auto& message) {
    exchange.add(message_type<std::decay_t<decltype(message)>>(), encoded(message));
  });
  const Json read = exchange.answer_to("decode");
  const Json wanted = wanted_json();
  ASSERT_EQ(read.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(read[i], wanted[i]);
}

// Detections are put together by hand in our tests: here by a definition, by someone else.
TEST(RosReference, ReadsDetections) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  Exchange exchange;
  exchange.add("vision_msgs/msg/Detection2DArray", test::detection_2d_payload());
  exchange.add("vision_msgs/msg/Detection3DArray", test::detection_3d_payload());
  const Json read = exchange.answer_to("decode");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0]["detections"][0]["bbox"]["center"]["position"]["x"], 320.5);
  EXPECT_EQ(read[0]["detections"][0]["results"][1]["hypothesis"]["class_id"], "person");
  EXPECT_EQ(read[1]["detections"][0]["bbox"]["size"]["z"], 0.3);
  EXPECT_EQ(read[1]["detections"][0]["id"], "box");
}

TEST(RosReference, ItsPlanningScenesAreFollowed) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  const auto turned = [](double z) -> Json {
    return {{"position", {{"x", 0}, {"y", 0}, {"z", z}}},
            {"orientation", {{"x", 0}, {"y", 0}, {"z", 1}, {"w", 0}}}};
  };
  Json part = Json::parse(R"({
    "header": {"stamp": {"sec": 12, "nanosec": 5}, "frame_id": "gripper"}, "id": "part",
    "primitives": [{"type": 1, "dimensions": [0.1, 0.2, 0.3]}],
    "meshes": [{"triangles": [{"vertex_indices": [0, 1, 2]}],
                "vertices": [{"x": 9}, {"x": 10}, {"y": 1}]}],
    "subframe_names": ["tip"]})");
  part["pose"] = turned(0.5);
  part["primitive_poses"] = Json::array({turned(1.0)});
  part["mesh_poses"] = Json::array({turned(0.0)});
  part["subframe_poses"] = Json::array({turned(2.0)});
  Json attached = Json::parse(R"({
    "link_name": "gripper", "touch_links": ["a", "bc"], "weight": 2.5,
    "detach_posture": {"joint_names": ["finger"],
                       "points": [{"positions": [1, 2], "effort": [3]}]}})");
  attached["object"] = part;
  Json scene = Json::parse(R"({
    "name": "scene", "robot_model_name": "arm", "is_diff": true,
    "robot_state": {
      "joint_state": {"header": {"stamp": {"sec": 12, "nanosec": 5}}, "name": ["finger"]},
      "is_diff": true,
      "multi_dof_joint_state": {"joint_names": ["base"],
                                "transforms": [{"rotation": {"w": 1}}],
                                "twist": [{"linear": {"x": 1}}], "wrench": [{"force": {"x": 1}}]}},
    "fixed_frame_transforms": [{"child_frame_id": "camera"}],
    "allowed_collision_matrix": {"entry_names": ["a"],
                                 "entry_values": [{"enabled": [true, false]}],
                                 "default_entry_values": [true]},
    "link_padding": [{"link_name": "gripper", "padding": 0.01}],
    "object_colors": [{"id": "part", "color": {"g": 1}}],
    "world": {"octomap": {"octomap": {"data": [1, 2, 3]}}}})");
  scene["robot_state"]["attached_collision_objects"] = Json::array({attached});
  scene["world"]["collision_objects"] = Json::array({part});
  Exchange exchange;
  const auto payload = exchange.encoded("moveit_msgs/msg/PlanningScene", scene);

  const auto message = test::decoded<PlanningSceneMessage>(payload);
  EXPECT_EQ(message.name, "scene");
  ASSERT_EQ(message.world.objects.size(), 1U);
  EXPECT_EQ(message.world.objects[0].id, "part");
  EXPECT_EQ(message.world.objects[0].primitives[0].dimensions[2], 0.3);
  AttachedInput input;
  Attachments attachments;
  EXPECT_EQ(input.take(message, 1, attachments), "");
  std::vector<AttachedBody> bodies;
  attachments.at(12'000'000'004, bodies);
  EXPECT_TRUE(bodies.empty());
  attachments.at(12'000'000'005, bodies);
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_EQ(bodies[0].name, "part");
  EXPECT_EQ(bodies[0].link, "gripper");
  EXPECT_EQ(bodies[0].T_link_body.translation().z(), 0.5);
  EXPECT_EQ(bodies[0].mesh->triangles.size(), 12U + 1U);
  EXPECT_NEAR(bodies[0].mesh->bounds.max().z(), 1.15, 1e-6);
  EXPECT_NEAR(bodies[0].mesh->bounds.min().x(), -10.0, 1e-6) << "turned by half a turn";
  const auto whole = exchange.encoded("moveit_msgs/msg/AttachedCollisionObject", attached);
  const auto object = test::decoded<AttachedObjectMessage>(whole);
  EXPECT_EQ(object.weight, 2.5);
  EXPECT_EQ(object.object.subframe_names, std::vector<std::string>{"tip"});
}

TEST(RosReference, ItsPlansAreRead) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  const Json plan = Json::parse(R"({
    "model_id": "arm",
    "trajectory": [{
      "joint_trajectory": {
        "header": {"frame_id": "base"}, "joint_names": ["a", "b"], "points": [
          {"positions": [1, 2], "velocities": [3, 4], "accelerations": [5, 6]},
          {"positions": [7, 8], "time_from_start": {"sec": 2, "nanosec": 500000000}}]},
      "multi_dof_joint_trajectory": {
        "joint_names": ["base"], "points": [
          {"transforms": [{"rotation": {"w": 1}}], "velocities": [{"linear": {"x": 1}}],
           "time_from_start": {"sec": 1}}]}}],
    "trajectory_start": {"joint_state": {"name": ["a"], "position": [0.25]}}})");
  Exchange exchange;
  const auto payload = exchange.encoded("moveit_msgs/msg/DisplayTrajectory", plan);
  const auto message = test::decoded<DisplayTrajectoryMessage>(payload);
  EXPECT_EQ(message.model_id, "arm");
  ASSERT_EQ(message.parts.size(), 1U);
  const JointTrajectoryMessage& read = message.parts[0].joints;
  EXPECT_EQ(read.joint_names, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(read.points.size(), 2U);
  EXPECT_EQ(read.points[0].accelerations, (std::vector{5.0, 6.0}));
  EXPECT_EQ(read.points[1].positions, (std::vector{7.0, 8.0}));
  EXPECT_EQ(read.points[1].time_from_start.nanosec, 500'000'000U);
  ASSERT_EQ(message.parts[0].floating.points.size(), 1U);
  EXPECT_EQ(message.parts[0].floating.points[0].time_from_start.sec, 1);
  EXPECT_EQ(message.start.joints.positions, std::vector{0.25});
}

// But for vision_msgs and our own, which it does not have.
TEST(RosReference, HasTheSameDefinitions) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  Exchange exchange;
  test::for_each_sample([&](const auto& message) {
    exchange.add(message_type<std::decay_t<decltype(message)>>(), {});
  });
  exchange.add("moveit_msgs/msg/PlanningScene", {});
  const Json types = exchange.answer_to("definitions");
  for (const auto& [name, both] : types.items()) EXPECT_EQ(both[0], both[1]) << name;
  EXPECT_GT(types.size(), 25U);
}

}  // namespace
}  // namespace penumbra::io
