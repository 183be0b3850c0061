// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags with targets.
#include "detections.hpp"
#include "fixtures.hpp"

#include <cstdint>
#include <map>

#include <Eigen/Geometry>

namespace penumbra::test {
namespace {

/// Of a Detection2DArray, pixels.
Detection square(const std::string& id, double u, double v, double size) {
  return {id, {u, v, 0.0, size, size}};
}

/// A detector that answers after 0.3 s, when the next frame is there.
TEST_F(BagTest, JudgesTargetsOnTheFrameOfTheirStamp) {
  const std::int64_t stamp = tiny_stamp(1), arrival = tiny_stamp(1) + 300'000'000;
  const io::MessageHeader header{stamp, "optical"};
  // On the object before the board, on the board, on the wall.
  bag_.messages.push_back(
      {"/detections", "vision_msgs/msg/Detection2DArray", arrival,
       detections_payload(header, {square("object", 28, 24, 6), square("board", 22, 26, 3),
                                   square("wall", 5, 5, 4)})});
  bag_.add("/wrist", arrival, io::KeypointsMessage{header, {{"left", 28, 24, 0.9, 0.5}}});
  bag_.add("/far", arrival, io::PoseStampedMessage{.header = {stamp, "map"}});
  bag_.add(
      "/goal", arrival,
      io::PoseStampedMessage{{stamp, "base"}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2))});
  std::vector<std::string> options;
  for (const char* topic : {"/detections", "/wrist", "/goal", "/far"})
    options.insert(options.end(), {"--target-topic", topic});
  const Outcome outcome = run(options);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.out, {"/wrist", "penumbra_msgs/msg/Keypoints"});
  const Json json = report();
  EXPECT_TRUE(json["frames"][0]["targets"].empty());
  EXPECT_TRUE(json["frames"][1]["targets"].empty());
  std::map<std::string, std::string> verdicts;
  for (const Json& target : json["frames"][2]["targets"]) {
    verdicts[target["name"]] = target["verdict"];
    if (target["name"] == "/far") {
      expect_has(std::string(target["reason"]), {"'map' is neither"});
    }
  }
  EXPECT_EQ(verdicts, (std::map<std::string, std::string>{{"/detections/object", "unknown"},
                                                          {"/detections/board", "hidden"},
                                                          {"/detections/wall", "visible"},
                                                          {"/wrist/left", "visible"},
                                                          {"/goal", "hidden"},
                                                          {"/far", "unknown"}}))
      << "an object that a detector first sees beside the robot may be larger than what it sees";
}

/// A turntable of which nothing is drawn, and which two programs see turned differently.
TEST_F(BagTest, TargetsInALinkThatTwoProgramsPutElsewhereAreUnknown) {
  bag_.edit<io::StringMessage>("/robot_description", [](auto& urdf) {
    urdf.data.insert(urdf.data.rfind("</robot>"), R"(<link name="turntable"/>
      <joint name="turn" type="continuous"><parent link="base"/><child link="turntable"/></joint>)");
  });
  bag_.edit<io::JointStateMessage>("/joint_states", [](auto& state) {
    state.names[0] = "turn";
    state.positions[0] = 0.0;
  });
  bag_.add("/goal", tiny_stamp(1) + 300'000'000,
           io::PoseStampedMessage{{tiny_stamp(1), "turntable"},
                                  Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2))});
  const std::vector<std::string> options = {"--target-topic", "/goal"};
  const auto target = [&] {
    EXPECT_EQ(run(options).status, 0);
    expect_recorded_labels();
    return report()["frames"][2]["targets"].at(0);
  };
  EXPECT_EQ(target()["verdict"], "hidden");
  for (std::int64_t stamp = tiny_stamp(0) - 190'000'000; stamp < tiny_stamp(3); stamp += 50'000'000)
    bag_.add("/joint_states", stamp,
             io::JointStateMessage{.header = {stamp, ""}, .names = {"turn"}, .positions = {0.7}});
  const Json told = target();
  EXPECT_EQ(told["verdict"], "unknown");
  for (const char* const part : {"'turntable'", "joint 'turn' is at "})
    EXPECT_NE(std::string(told["reason"]).find(part), std::string::npos) << told;
}

}  // namespace
}  // namespace penumbra::test
