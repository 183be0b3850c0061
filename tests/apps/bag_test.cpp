// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags, against the recording folders that they are of.
#include "bag_fixture.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace penumbra::test
