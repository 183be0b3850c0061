// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags with Foxglove's messages in protobuf.
#include "fixtures.hpp"

#include <io/files/pose_file.hpp>

namespace penumbra::test {
namespace {

class FoxgloveBagTest : public BagTest {
 protected:
  FoxgloveBagTest() { bag_.to_foxglove(); }
  Outcome run(const Words& options = {}) const {
    return BagTest::run(Words{"--robot", path("tiny.urdf")} + options);
  }
  Outcome expect_recorded(const Words& options = {}) const {
    return BagTest::expect_recorded(Words{"--robot", path("tiny.urdf")} + options);
  }
  TinyBag::Message& first(const std::string& topic) {
    return *std::ranges::find(bag_.messages, topic, &TinyBag::Message::topic);
  }
};

TEST_F(FoxgloveBagTest, GivesTheLabelsOfTheRecording) {
  const Outcome outcome = expect_recorded();
  EXPECT_EQ(outcome.err, "");
  expect_has(outcome.out, {"(foxglove.RawImage)", "(foxglove.JointStates)"});
  EXPECT_EQ(report()["frames"][1]["stamp_ns"], tiny_stamp(1));
}

TEST_F(FoxgloveBagTest, TopicsAreFoundByTheirTypes) {
  bag_.copy("/tf_static", "/frames/static");
  const auto is_second = [&](const TinyBag::Message& message) {
    return message.log_time % 1'000'000 != 0;
  };
  std::erase_if(bag_.messages, [&](const auto& message) {
    return (message.topic == "/tf_static" && is_second(message)) ||
           (message.topic == "/frames/static" && !is_second(message));
  });
  bag_.rename("/joint_states", "/arm");
  bag_.rename(info_topic, "/camera/depth/calibration");
  EXPECT_EQ(expect_recorded().err, "");
}

TEST_F(FoxgloveBagTest, ShowsColorInOverlays) {
  saves_ = "overlay";
  EXPECT_EQ(succeed(run()).err, "");
  const std::string of_foxglove = read_file(out("overlay/000002.png"));
  bag_ = tiny_bag(path());
  succeed(run());
  EXPECT_TRUE(of_foxglove == read_file(out("overlay/000002.png")));
}

TEST_F(FoxgloveBagTest, OfTheExampleGivesTheLabelsOfTheRecording) {
  bag_ = recording_bag(example, io::read_pose_csv(example / "camera_pose.csv"));
  bag_.to_foxglove();
  const Words saved = {"--save", "labels", "--frames", "0:10"};
  succeed(penumbra(Words{"run", example, "-o", path("wanted")} + saved));
  const Outcome outcome = succeed(penumbra(
      Words{"run", tiny_mcap(), "-o", out(), "--robot", example / "arm_description/arm.urdf"} +
      example_package + saved));
  EXPECT_EQ(outcome.err, "");
  const std::size_t frames = report()["frames"].size();
  EXPECT_EQ(frames, 10U);
  for (std::size_t i = 0; i < frames; ++i)
    EXPECT_TRUE(read_file(out("labels") / numbered(i)) ==
                read_file(path("wanted/labels") / numbered(i)))
        << i;
}

TEST_F(FoxgloveBagTest, MessagesThatCannotBeReadAreToldAndTheRestIsJudged) {
  first(depth_topic).data.pop_back();
  first("/joint_states").data.assign(3, std::byte{0xff});
  const Outcome outcome = succeed(run());
  EXPECT_NE(statuses()[0], "ok");
  expect_has(message(0), {"foxglove.RawImage: byte "});
  for (const std::string& said : {notes(), outcome.err})
    expect_has(said, {"1 message of /joint_states", "foxglove.JointStates: "});
  expect_recorded_labels(1);
}

TEST_F(FoxgloveBagTest, SchemasWithOtherFieldsAreRefused) {
  bag_.schemas = foxglove::descriptors(
      replaced(foxglove::all_schemas, "2 position 1 1\n3 velocity", "3 position 1 1\n2 velocity"));
  expect_refused(run(), {"tiny.mcap", "/joint_states", "foxglove.JointStates",
                         "field 2 of JointState is 'velocity'; expected position"});
}

TEST_F(FoxgloveBagTest, WhatIsNotReadIsRefusedByName) {
  expect_refused(BagTest::run(), {"--robot"});
  for (TinyBag::Message& message : bag_.messages)
    if (message.topic == color_topic) message.type = "foxglove.CompressedVideo";
  for (const Words& options : {Words{"--no-depth"}, Words{"--color-topic", color_topic}})
    expect_refused(run(options), {color_topic, "CompressedVideo", "foxglove.CompressedImage"});
  EXPECT_EQ(expect_recorded().err, "") << "depth needs no video";

  for (TinyBag::Message& message : bag_.messages) message.type = "foxglove.Log";
  expect_refused(run(), {"foxglove.Log", "protobuf"});
}

}  // namespace
}  // namespace penumbra::test
