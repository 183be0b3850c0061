// SPDX-License-Identifier: Apache-2.0
// Our definitions and payloads, read by Foxglove's library, and its definitions against ours.
#include "../support/node_scripts.hpp"
#include "files.hpp"
#include "ros_samples.hpp"

#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

  Json decoded() { return answer("decode " + folder.write("list", list).string()); }
};

Json header_json() {
  return {{"stamp", {{"sec", 1'699'999'999}, {"nanosec", 987'654'321}}},
          {"frame_id", "camera/optical"}};
}

Json pose_json(const Eigen::Isometry3d& pose, const char* at, const char* turned) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {{at, {{"x", t.x()}, {"y", t.y()}, {"z", t.z()}}},
          {turned, {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

const Json bytes_json = {1, 2, 250, 0, 7};

Json camera_json() {
  const auto info = test::sample<CameraInfoMessage>();
  return {{"header", header_json()},
          {"height", 480},
          {"width", 640},
          {"distortion_model", "plumb_bob"},
          {"d", info.d},
          {"k", info.k},
          {"r", info.r},
          {"p", info.p},
          {"binning_x", 2},
          {"binning_y", 4},
          {"roi",
           {{"x_offset", 1}, {"y_offset", 2}, {"height", 3}, {"width", 4}, {"do_rectify", true}}}};
}

Json tf_json() {
  const Json second = {{"stamp", {{"sec", -1}, {"nanosec", 999'999'999}}}, {"frame_id", "a"}};
  return {{"transforms",
           {{{"header", header_json()},
             {"child_frame_id", "tool"},
             {"transform", pose_json(test::sample_pose(), "translation", "rotation")}},
            {{"header", second},
             {"child_frame_id", ""},
             {"transform", pose_json(test::sample_pose().inverse(), "translation", "rotation")}}}}};
}

TEST(RosReference, ReadsWhatWeWrite) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    Exchange exchange;
    std::vector<std::string> types;
    test::for_each_sample([&](const auto& message) {
      types.push_back(message_type<std::decay_t<decltype(message)>>());
      exchange.add(types.back(), encoded(message, order));
    });
    const Json read = exchange.decoded();
    ASSERT_EQ(read.size(), types.size());
    std::map<std::string, Json> of;
    for (std::size_t i = 0; i < types.size(); ++i) of[types[i]] = read[i];
    EXPECT_EQ(of["sensor_msgs/msg/Image"], (Json{{"header", header_json()},
                                                 {"height", 1},
                                                 {"width", 5},
                                                 {"encoding", "mono8"},
                                                 {"is_bigendian", 0},
                                                 {"step", 5},
                                                 {"data", bytes_json}}));
    EXPECT_EQ(of["sensor_msgs/msg/CompressedImage"]["data"], bytes_json);
    EXPECT_EQ(of["sensor_msgs/msg/CameraInfo"], camera_json());
    EXPECT_EQ(of["sensor_msgs/msg/JointState"], (Json{{"header", header_json()},
                                                      {"name", {"elbow", "", "shoulder_pan"}},
                                                      {"position", {0.5, -1.25, 3}},
                                                      {"velocity", Json::array()},
                                                      {"effort", {7, 8}}}));
    EXPECT_EQ(of["tf2_msgs/msg/TFMessage"], tf_json());
    EXPECT_EQ(of["std_msgs/msg/String"]["data"], "<robot name=\"r\"/>");
    EXPECT_EQ(of["geometry_msgs/msg/PoseStamped"]["pose"],
              pose_json(test::sample_pose(), "position", "orientation"));
    const Json& cloud = of["sensor_msgs/msg/PointCloud2"];
    EXPECT_EQ(cloud["fields"][1]["name"], "intensity");
    EXPECT_EQ(cloud["data"], bytes_json);
    EXPECT_EQ(cloud["is_dense"], true);
    const Json& status = of["diagnostic_msgs/msg/DiagnosticArray"]["status"];
    EXPECT_EQ(status[0]["values"][1]["value"], "3");
    EXPECT_EQ(status[1]["name"], "joints");
    EXPECT_EQ(of["penumbra_msgs/msg/Keypoints"]["keypoints"][0]["depth"], 1.25);
    const Json& targets = of["penumbra_msgs/msg/Targets"];
    EXPECT_EQ(targets["status"], "stale_joints");
    const Json &part = targets["targets"][0], &wrist = targets["targets"][1];
    EXPECT_EQ(part["stamp"], (Json{{"sec", 5}, {"nanosec", 1}}));
    EXPECT_EQ(part["verdict"], 2);
    EXPECT_EQ(part["covered"], "5000000000");
    EXPECT_EQ(part["blame"][1]["link"], "tool");
    EXPECT_EQ(part["pose"]["position"]["z"], 6);
    EXPECT_EQ(part["estimate"], 3);
    EXPECT_EQ(wrist["reason"], "joint states are stale");
    EXPECT_EQ(wrist["occluded_fraction"], "NaN");
    EXPECT_EQ(wrist["age"], "Infinity");
  }
}

// Detections are put together by hand in our tests: here by a definition, by someone else.
TEST(RosReference, ReadsDetections) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  Exchange exchange;
  exchange.add("vision_msgs/msg/Detection2DArray", test::detection_2d_payload());
  exchange.add("vision_msgs/msg/Detection3DArray", test::detection_3d_payload());
  const Json read = exchange.decoded();
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0]["detections"][0]["bbox"]["center"]["position"]["x"], 320.5);
  EXPECT_EQ(read[0]["detections"][0]["results"][1]["hypothesis"]["class_id"], "person");
  EXPECT_EQ(read[1]["detections"][0]["bbox"]["size"]["z"], 0.3);
  EXPECT_EQ(read[1]["detections"][0]["id"], "box");
}

Json fields_json(const TypeDefinition& type) {
  Json fields = Json::array();
  for (const ConstantDefinition& constant : type.constants)
    fields.push_back({constant.name, constant.type_name == "byte" ? "uint8" : constant.type_name,
                      "constant", constant.value_text});
  for (const FieldDefinition& field : type.fields) {
    std::string name = field.type_name == "byte" ? "uint8" : field.type_name;
    if (name == "builtin_interfaces/Time") name = "time";
    const std::string shape = field.arity == Arity::one ? ""
                              : field.arity == Arity::array
                                  ? "[" + std::to_string(field.count) + "]"
                                  : "[]";
    fields.push_back({field.name, name, shape, ""});
  }
  return fields;
}

// But for vision_msgs and our own, which it does not have.
TEST(RosReference, HasTheSameDefinitions) {
  PENUMBRA_REQUIRE_NODE_SCRIPTS();
  const Json theirs = answer("definitions");
  std::size_t compared = 0;
  test::for_each_sample([&](const auto& message) {
    const std::string type = message_type<std::decay_t<decltype(message)>>();
    const MessageDefinition definition(type, definition_of(type));
    for (const TypeDefinition& one : definition.types()) {
      if (!theirs.contains(one.name)) continue;
      EXPECT_EQ(fields_json(one), theirs[one.name]) << one.name;
      ++compared;
    }
  });
  EXPECT_GT(compared, 20U);
}

}  // namespace
}  // namespace penumbra::io
