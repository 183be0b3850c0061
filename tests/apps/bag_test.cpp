// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags, against the recording folders that they are of.
#include "bag_fixture.hpp"

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <io/ros/cdr_writer.hpp>

namespace penumbra::test {
namespace {

TEST_F(BagTest, GivesTheLabelsOfTheRecording) {
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  expect_recorded_labels();
  const Json json = report();
  ASSERT_EQ(json["frames"].size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(json["frames"][i]["index"], i);
    EXPECT_EQ(json["frames"][i]["stamp_ns"], tiny_stamp(static_cast<int>(i)));
    EXPECT_GT(json["frames"][i]["joint_age_ms"], 0.0) << "no state lies on a stamp";
  }
}

TEST_F(BagTest, AFolderOfAKilledRecorderIsRead) {
  const fs::path bags = folder_.path() / "killed";
  fs::create_directory(bags);
  bag_.write_mcap(bags / "killed_0.mcap");
  const Outcome outcome = run({}, "killed");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("metadata.yaml: is missing"), std::string::npos) << outcome.err;
  expect_recorded_labels();
}

TEST_F(BagTest, SaysWhichTopicsItTakes) {
  const Outcome outcome = run();
  for (const char* said : {"depth: /camera/depth/image_rect_raw (sensor_msgs/msg/Image), ",
                           "camera_info: /camera/depth/camera_info (",
                           "robot: /robot_description (std_msgs/msg/String), ",
                           "joints: /joint_states (sensor_msgs/msg/JointState), ",
                           "transforms: /tf_static (tf2_msgs/msg/TFMessage), ",
                           "camera: frame 'optical' on link 'base', by tf"})
    EXPECT_NE(outcome.out.find(said), std::string::npos) << said << " is not in " << outcome.out;
  EXPECT_EQ(outcome.out.find("color"), std::string::npos) << "no colour is asked for";
}

TEST_F(BagTest, ReadsSqliteBagsAndFolders) {
  bag_.write_sqlite(folder_.path() / "tiny.db3");
  ASSERT_EQ(run({}, "tiny.db3").status, 0);
  expect_recorded_labels();

  const fs::path folder = folder_.path() / "recorded";
  fs::create_directory(folder);
  bag_.write_mcap(folder / "a_0.mcap");
  write_file(folder / "metadata.yaml",
             "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
             "  relative_file_paths:\n    - a_0.mcap\n  message_count: 1\n"
             "  topics_with_message_count: []\n  compression_format: ''\n"
             "  compression_mode: ''\n");
  write_file(folder_.path() / "recorded" / "board.stl", board_stl());
  const Outcome outcome = run({}, "recorded");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_recorded_labels();
}

TEST_F(BagTest, ShowsColorInOverlays) {
  saves_ = "overlay";
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const std::string with_color = read_file(out() / "overlay" / "000002.png");

  bag_.edit<io::CompressedImageMessage>("/camera/color/image_raw/compressed",
                                        [](auto& image) { image.header.frame_id = "left"; });
  const Outcome other = run();
  EXPECT_EQ(other.status, 0);
  EXPECT_NE(other.err.find("no colour in the overlay of 3 of 3 frames"), std::string::npos)
      << other.err;
  EXPECT_NE(read_file(out() / "overlay" / "000002.png"), with_color);
}

TEST_F(BagTest, TakesSomeFrames) {
  ASSERT_EQ(run({"--frames", "1:2"}).status, 0);
  const Json json = report();
  ASSERT_EQ(json["frames"].size(), 1U);
  EXPECT_EQ(json["frames"][0]["index"], 1);
  expect_recorded_labels(1, 2);

  const Outcome outcome = run({"--frames", "1:4"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("0 to 2"), std::string::npos) << outcome.err;
}

TEST_F(BagTest, AddsTheTimeOffsetToStamps) {
  // What a camera says that stamps 0.4 s too early.
  bag_.edit<io::ImageMessage>("/camera/depth/image_rect_raw",
                              [](auto& image) { image.header.stamp -= 400'000'000; });
  ASSERT_EQ(run({"--time-offset", "0.4"}).status, 0);
  expect_recorded_labels();
  EXPECT_EQ(report()["frames"][0]["stamp_ns"], tiny_stamp(0) - 400'000'000);
}

TEST_F(BagTest, FramesWithoutPoseAreFrames) {
  std::erase_if(bag_.messages, [](const auto& message) {
    return message.topic == "/joint_states" && message.log_time > tiny_stamp(1) - 200'000'000 &&
           message.log_time < tiny_stamp(1) + 200'000'000;
  });
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(status(0), "ok");
  EXPECT_EQ(status(1), "stale_joints");
  EXPECT_EQ(status(2), "ok");
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
}

TEST_F(BagTest, FaultyImagesAreFramesOfAStatus) {
  int image = 0;
  bag_.edit<io::ImageMessage>("/camera/depth/image_rect_raw", [&](auto& depth) {
    if (image == 0) depth.encoding = "13UC7";
    if (image == 1) depth.header.stamp = 0;
    if (image == 2) depth.header.frame_id = "elsewhere";
    ++image;
  });
  for (auto& message : bag_.messages)
    if (message.topic == "/joint_states") {
      message.data.resize(20);
      break;
    }
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2) << "no frame is usable";
  EXPECT_EQ(status(0), "bad_depth");
  EXPECT_NE(message(0).find("13UC7"), std::string::npos) << message(0);
  EXPECT_EQ(status(1), "missing_joints");
  EXPECT_NE(message(1).find("stamp is 0"), std::string::npos) << message(1);
  EXPECT_EQ(status(2), "bad_depth");
  EXPECT_NE(message(2).find("'elsewhere'"), std::string::npos) << message(2);
  const std::string notes = report()["summary"]["notes"].dump();
  EXPECT_NE(notes.find("1 message of /joint_states cannot be used"), std::string::npos) << notes;
  EXPECT_NE(outcome.err.find("1 message of /joint_states"), std::string::npos) << outcome.err;
}

TEST_F(BagTest, JointPositionsThatAreNoNumbersAreTold) {
  int state = 0;
  bag_.edit<io::JointStateMessage>("/joint_states", [&](auto& joints) {
    if (++state == 3) joints.positions.at(1) = std::numeric_limits<double>::quiet_NaN();
    if (state == 4) joints.positions.resize(1);
  });
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("tiny.mcap: joint positions not used: 2 "), std::string::npos)
      << outcome.err;
  const std::string notes = report()["summary"]["notes"].dump();
  EXPECT_NE(notes.find("joint positions not used: 2 "), std::string::npos) << notes;
}

TEST_F(BagTest, DamageIsToldAndTheRestIsJudged) {
  bag_.write_mcap(folder_.path() / "whole.mcap");
  const std::string whole = read_file(folder_.path() / "whole.mcap");
  write_file(folder_.path() / "cut.mcap", whole.substr(0, whole.size() * 7 / 10));
  const Outcome outcome = run({}, "cut.mcap");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t frames = report()["frames"].size();
  EXPECT_GE(frames, 1U);
  EXPECT_LT(frames, 3U);
  EXPECT_NE(outcome.err.find("cut.mcap: byte "), std::string::npos) << outcome.err;
  EXPECT_NE(report()["summary"]["notes"].dump().find("cut.mcap: byte "), std::string::npos);
  expect_recorded_labels(0, 1);
}

TEST_F(BagTest, DamageIsToldWhereNothingIsLeft) {
  bag_.write_mcap(folder_.path() / "whole.mcap");
  const std::string whole = read_file(folder_.path() / "whole.mcap");
  write_file(folder_.path() / "cut.mcap", whole.substr(0, 300));  // in the first chunk
  const Outcome outcome = run({}, "cut.mcap");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find("holds no messages; "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("cut.mcap: byte "), std::string::npos) << outcome.err;
}

TEST_F(BagTest, TakesPosesFromTransforms) {
  for (std::int64_t stamp = tiny_stamp(0) - 130'000'000; stamp < tiny_stamp(3);
       stamp += 100'000'000) {
    const double seconds = static_cast<double>(stamp - tiny_stamp(0)) * 1e-9;
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 1 + tiny_speed * seconds));
    bag_.add("/tf", stamp, io::TfMessage{{{{stamp, "base"}, "board", pose}}});
  }
  for (const char* const poses : {"tf", "both", "joints"}) {
    ASSERT_EQ(run({"--poses", poses}).status, 0) << poses;
    expect_recorded_labels();
  }
  bag_.edit<io::TfMessage>(
      "/tf", [](auto& tf) { tf.transforms[0].T_parent_child.translation().z() += 0.01; });
  const Outcome outcome = run({"--poses", "both"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(status(1), "poses_disagree");
  EXPECT_NE(outcome.err.find("poses_disagree in 3 of 3 frames"), std::string::npos) << outcome.err;

  bag_.remove("/joint_states");
  EXPECT_NE(run().out.find("poses: from tf"), std::string::npos);
}

TEST_F(BagTest, JointStatesOfTwoProgramsThatContradictEachOtherAreToldAndNotUsed) {
  // joint_state_publisher beside the driver: all joints of its own order, no sliders moved.
  for (std::int64_t stamp = tiny_stamp(0) - 190'000'000; stamp < tiny_stamp(3);
       stamp += 100'000'000)
    bag_.add("/joint_states", stamp,
             io::JointStateMessage{
                 .header = {stamp, ""}, .names = {"slide", "other"}, .positions = {-0.3, 0.0}});
  Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(status(1), "poses_disagree");
  for (const char* const part : {"poses_disagree in 3 of 3 frames", "joint 'slide' is at ",
                                 "/joint_states (2 joints from "
                                 "'other')",
                                 "/joint_states (2 joints from 'slide')"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
}

TEST_F(BagTest, TheFirstPublisherMayBeBelieved) {
  bag_.copy("/joint_states", "/second/joint_states");
  bag_.edit<io::JointStateMessage>("/second/joint_states", [](auto& state) {
    state.header.stamp += 1'000'000;
    state.positions[1] = -0.3;
  });
  const std::vector<std::string> both = {"--joint-topic", "/joint_states", "--joint-topic",
                                         "/second/joint_states"};
  EXPECT_EQ(run(both).status, 2);
  std::vector<std::string> first = both;
  first.push_back("--first-publisher");
  ASSERT_EQ(run(first).status, 0);
  expect_recorded_labels();
}

TEST_F(BagTest, ACopyOfJointStatesIsUsedAsTheyAre) {
  bag_.copy("/joint_states", "/relayed/joint_states");
  bag_.edit<io::JointStateMessage>("/relayed/joint_states",
                                   [](auto& state) { state.header.stamp += 30'000'000; });
  ASSERT_EQ(
      run({"--joint-topic", "/relayed/joint_states", "--joint-topic", "/joint_states"}).status, 0);
  expect_recorded_labels();
}

TEST_F(BagTest, TheCommandLineFillsInWhatIsMissing) {
  bag_.remove("/robot_description");
  bag_.remove("/tf_static");
  const Outcome outcome = run({"--robot", folder_.path() / "tiny.urdf", "--pose",
                               folder_.path() / "camera_pose.csv", "--parent", "base"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_recorded_labels();
}

TEST_F(BagTest, OptionsChooseAmongTopics) {
  bag_.copy("/camera/depth/image_rect_raw", "/other/depth/image");
  bag_.copy("/camera/depth/camera_info", "/other/camera_info");
  bag_.copy("/joint_states", "/second/joint_states");
  bag_.rename("/joint_states", "/first/joint_states");
  const Outcome outcome =
      run({"--depth-topic", "/other/depth/image", "--camera-info-topic", "/other/camera_info",
           "--joint-topic", "/first/joint_states", "--joint-topic", "/second/joint_states"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_recorded_labels();
}

/// Depth of a camera that sits where the color camera does, but for its frame's name.
TEST_F(BagTest, DepthIsBroughtToTheColorCamera) {
  bag_.edit<io::ImageMessage>("/camera/depth/image_rect_raw",
                              [](auto& image) { image.header.frame_id = "infrared"; });
  bag_.copy("/camera/depth/camera_info", "/camera/color/camera_info");
  bag_.edit<io::CameraInfoMessage>("/camera/depth/camera_info",
                                   [](auto& info) { info.header.frame_id = "infrared"; });
  const std::vector<std::string> color = {"--color-topic", "/camera/color/image_raw/compressed"};
  const Outcome without = run(color);
  EXPECT_EQ(without.status, 2) << "tf does not say where one camera is from the other";
  EXPECT_EQ(status(0), "bad_depth");
  EXPECT_NE(message(0).find("infrared"), std::string::npos) << message(0);

  bag_.add("/tf_static", tiny_stamp(2),
           io::TfMessage{{{{0, "optical"}, "infrared", Eigen::Isometry3d::Identity()}}});
  const Outcome outcome = run(color);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("camera: frame 'optical'"), std::string::npos) << outcome.out;
  expect_recorded_labels();

  // Of the two cameras one changes for the second image.
  int info = 0;
  bag_.edit<io::CameraInfoMessage>("/camera/depth/camera_info", [&](auto& camera) {
    if (++info == 2) camera.p[0] = 61;
  });
  ASSERT_EQ(run(color).status, 0);
  EXPECT_EQ(status(0), "ok");
  EXPECT_EQ(status(1), "bad_depth");
  EXPECT_EQ(status(2), "ok");
}

struct Square {
  std::string id;
  double u, v, size;  // pixels
};

/// vision_msgs/Detection2DArray, put together by the fields of its definition.
std::vector<std::byte> detections_payload(const io::MessageHeader& header,
                                          const std::vector<Square>& squares) {
  std::vector<std::byte> payload;
  io::CdrWriter writer(payload);
  const auto write_header = [&] {
    writer.write(static_cast<std::int32_t>(header.stamp / 1'000'000'000));
    writer.write(static_cast<std::uint32_t>(header.stamp % 1'000'000'000));
    writer.write_string(header.frame_id);
  };
  write_header();
  writer.write_count(squares.size());
  for (const Square& square : squares) {
    write_header();
    writer.write_count(0);  // hypotheses
    for (const double value : {square.u, square.v, 0.0, square.size, square.size})
      writer.write(value);
    writer.write_string(square.id);
  }
  return payload;
}

/// A detector that answers after 0.3 s, when the next frame is there.
TEST_F(BagTest, JudgesTargetsOnTheFrameOfTheirStamp) {
  const std::int64_t stamp = tiny_stamp(1), arrival = tiny_stamp(1) + 300'000'000;
  const io::MessageHeader header{stamp, "optical"};
  // On the object before the board, on the board, on the wall.
  bag_.messages.push_back(
      {"/detections", "vision_msgs/msg/Detection2DArray", arrival,
       detections_payload(header,
                          {{"object", 28, 24, 6}, {"board", 22, 26, 3}, {"wall", 5, 5, 4}})});
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
  EXPECT_NE(outcome.out.find("targets: /wrist (penumbra_msgs/msg/Keypoints)"), std::string::npos);
  const Json json = report();
  EXPECT_TRUE(json["frames"][0]["targets"].empty());
  EXPECT_TRUE(json["frames"][1]["targets"].empty());
  std::map<std::string, std::string> verdicts;
  for (const Json& target : json["frames"][2]["targets"]) {
    verdicts[target["name"]] = target["verdict"];
    if (target["name"] == "/far") {
      EXPECT_NE(std::string(target["reason"]).find("'map' is neither"), std::string::npos);
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
