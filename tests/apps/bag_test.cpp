// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags, against the recording folders that they are of.
#include "../io/bag_files.hpp"
#include "fixtures.hpp"

#include <limits>

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

TEST_F(BagTest, ReadsSqliteBagsAndFolders) {
  bag_.write_sqlite(path("tiny.db3"));
  ASSERT_EQ(run({}, "tiny.db3").status, 0);
  expect_recorded_labels();

  fs::create_directory(path("recorded"));
  bag_.write_mcap(path("recorded/a_0.mcap"));
  const Outcome killed = run({}, "recorded");
  ASSERT_EQ(killed.status, 0) << killed.err;
  expect_has(killed.err, {"metadata.yaml: is missing"});
  expect_recorded_labels();

  write_file(path("recorded/metadata.yaml"), metadata_yaml("mcap", {"a_0.mcap"}));
  const Outcome outcome = run({}, "recorded");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
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
  expect_has(other.err, {"colour", "3 of 3"});
  EXPECT_NE(read_file(out() / "overlay" / "000002.png"), with_color);
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
  expect_has(message(0), {"13UC7"});
  EXPECT_EQ(status(1), "missing_joints");
  expect_has(message(1), {"stamp is 0"});
  EXPECT_EQ(status(2), "bad_depth");
  expect_has(message(2), {"'elsewhere'"});
  const std::string notes = report()["summary"]["notes"].dump();
  expect_has(notes, {"1 message of /joint_states"});
  expect_has(outcome.err, {"1 message of /joint_states"});
}

TEST_F(BagTest, JointPositionsThatAreNoNumbersAreTold) {
  int state = 0;
  bag_.edit<io::JointStateMessage>("/joint_states", [&](auto& joints) {
    if (++state == 3) joints.positions.at(1) = std::numeric_limits<double>::quiet_NaN();
    if (state == 4) joints.positions.resize(1);
  });
  const Outcome outcome = run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_has(outcome.err, {"tiny.mcap: ", ": 2 "});
  const std::string notes = report()["summary"]["notes"].dump();
  expect_has(notes, {"joint positions not used: 2 "});
}

TEST_F(BagTest, DamageIsToldAndTheRestIsJudged) {
  bag_.write_mcap(path("whole.mcap"));
  const std::string whole = read_file(path("whole.mcap"));
  write_file(path("cut.mcap"), whole.substr(0, whole.size() * 7 / 10));
  const Outcome outcome = run({}, "cut.mcap");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t frames = report()["frames"].size();
  EXPECT_GE(frames, 1U);
  EXPECT_LT(frames, 3U);
  expect_has(outcome.err, {"cut.mcap: byte "});
  expect_has(report()["summary"]["notes"].dump(), {"cut.mcap: byte "});
  expect_recorded_labels(0, 1);
}

TEST_F(BagTest, TheCommandLineFillsInWhatIsMissing) {
  bag_.remove("/robot_description");
  bag_.remove("/tf_static");
  const Outcome outcome =
      run({"--robot", path("tiny.urdf"), "--pose", path("camera_pose.csv"), "--parent", "base"});
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

}  // namespace
}  // namespace penumbra::test
