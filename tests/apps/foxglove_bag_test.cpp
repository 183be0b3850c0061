// SPDX-License-Identifier: Apache-2.0
// `penumbra run` of bags with Foxglove's messages in protobuf.
#include "../io/h264_messages.hpp"
#include "fixtures.hpp"

#include <io/files/pose_file.hpp>
#include <io/ros/image_codec.hpp>

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
  for (TinyBag::Message& message : bag_.messages) message.type = "foxglove.Log";
  expect_refused(run(), {"foxglove.Log", "protobuf"});
}

// The color images of the tiny recording as a video, with another frame after each.
class VideoBagTest : public FoxgloveBagTest {
 protected:
  void SetUp() override {
    PENUMBRA_REQUIRE_FFMPEG();
    saves_ = "overlay";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string ending = std::to_string(i) + ".png";
      const auto color = read_image<Rgb8>(path("color_" + ending));
      Image<Rgb8> turned = color;
      std::reverse(turned.data(), turned.data() + turned.size());
      frames_.insert(frames_.end(), {color, turned});
    }
    videos_ = h264_messages(frames_);
    const ColorFrames decoded = h264_frames(videos_, frames_[0]);
    set_color([&](std::size_t i) {
      const auto image = io::image_message(header(i), "rgb8", decoded[i].view());
      return std::pair("foxglove.RawImage", foxglove::encode(image));
    });
    images_ = bag_;
    set_video();
  }

  static io::MessageHeader header(std::size_t i) {
    return {tiny_stamp(0) + 200'000'000 * static_cast<std::int64_t>(i), "optical"};
  }
  template <typename F>
  void set_color(const F& message_of) {
    bag_.remove(topic_);
    bag_.remove(color_topic);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const auto [type, bytes] = message_of(i);
      const auto span = std::as_bytes(std::span(bytes));
      bag_.messages.push_back(
          {topic_, type, header(i).stamp + 30'000'000, {span.begin(), span.end()}});
    }
    bag_.sort();
  }
  void set_video(const std::string& format = "h264") {
    set_color([&](std::size_t i) {
      const auto data = std::as_bytes(std::span(videos_[i]));
      return std::pair("foxglove.CompressedVideo",
                       foxglove::encode(io::CompressedVideoMessage{header(i), data, format}));
    });
  }
  /// Expects the overlays of the frames that ffmpeg decodes of the stream.
  void expect_overlays(const Words& options = {}, std::size_t first = 0) {
    expect_lacks(succeed(run(options)).err, {"no colour"});
    const TinyBag video = std::exchange(bag_, images_);
    std::vector<std::string> found;
    for (std::size_t i = first; i < 3; ++i)
      found.push_back(read_file(out("overlay") / numbered(i)));
    succeed(run(options));
    for (std::size_t i = first; i < 3; ++i)
      EXPECT_TRUE(found[i - first] == read_file(out("overlay") / numbered(i))) << i;
    bag_ = video;
  }

  const std::string topic_ = "/camera/color/image_raw/foxglove";
  ColorFrames frames_;
  std::vector<std::string> videos_;
  TinyBag images_;  // the bag with the frames as images
};

TEST_F(VideoBagTest, ShowsVideosInOverlays) { expect_overlays(); }

TEST_F(VideoBagTest, FramesBeforeTheRangeAreDecoded) {
  const Words range = {"--frames", "2:3"};
  expect_overlays(range, 2);
  expect_overlays(range + Words{"--no-depth"}, 2);
}

TEST_F(VideoBagTest, IsReadInMessagesOfRos2) {
  set_color([this](std::size_t i) {
    const std::int64_t stamp = header(i).stamp;
    std::string bytes = raw(std::uint32_t{0x100}, static_cast<std::int32_t>(stamp / 1'000'000'000),
                            static_cast<std::uint32_t>(stamp % 1'000'000'000), std::uint32_t{8}) +
                        std::string("optical\0", 8) +
                        raw(static_cast<std::uint32_t>(videos_[i].size())) + videos_[i];
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return std::pair("foxglove_msgs/msg/CompressedVideo",
                     bytes + raw(std::uint32_t{5}) + std::string("h264\0", 5));
  });
  expect_overlays();
}

TEST_F(VideoBagTest, WhatCannotBeDecodedIsReportedAndDepthIsJudged) {
  const std::string keyframe = std::exchange(videos_[0], "");
  set_video();
  saves_ = "labels,overlay";
  expect_has(expect_recorded().err, {"no colour", "2 of 3 frames", "has 0 frames"});
  expect_has(succeed(run({"--frames", "1:2"})).err, {"1 of 1 frames", "keyframe"});
  videos_[0] = keyframe;
  set_video("vp9");
  expect_has(expect_recorded().err, {"3 of 3 frames", "'vp9'", "h264"});
  expect_refused(run({"--depth-topic", topic_}), {topic_, "foxglove.CompressedVideo", "Image"});
}

TEST_F(VideoBagTest, WithoutFfmpegItsPackageIsNamed) {
  fs::create_directories(path("bin"));
  fs::create_symlink("/usr/bin/timeout", path("bin/timeout"));  // which starts programs
  const Outcome outcome = succeed(penumbra(
      {"run", tiny_mcap(), "-o", out(), "--save", "labels,overlay", "--robot", path("tiny.urdf")},
      {"PATH=" + path("bin").string()}));
  expect_has(outcome.err, {"no colour", "3 of 3 frames", "apt install ffmpeg"});
  expect_recorded_labels();
}

}  // namespace
}  // namespace penumbra::test
