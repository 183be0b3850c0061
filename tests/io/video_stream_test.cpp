// SPDX-License-Identifier: Apache-2.0
// Videos in messages, against what ffmpeg makes of the whole stream.
#include "h264_messages.hpp"

#include <algorithm>

#include <sys/wait.h>

#include <io/files/h264.hpp>
#include <io/files/video_file.hpp>

namespace penumbra::io {
namespace {

constexpr int key_every = 4;
using Messages = std::vector<std::string>;

/// Noise that moves, so that frames differ and need each other.
test::ColorFrames moving_frames(int count, int width = 64, int height = 48) {
  std::mt19937_64 random = test::seeded_random(41);
  Image<Rgb8> noise(width, height);
  for (Rgb8& pixel : std::span(noise.data(), noise.size()))
    for (auto* channel : {&pixel.r, &pixel.g, &pixel.b})
      *channel = static_cast<std::uint8_t>(random() % 256);
  test::ColorFrames frames;
  for (int i = 0; i < count; ++i) {
    std::rotate(noise.data(), noise.data() + 1, noise.data() + noise.size());
    frames.push_back(noise);
  }
  return frames;
}

class VideoStreamTest : public testing::Test {
 protected:
  void SetUp() override { PENUMBRA_REQUIRE_FFMPEG(); }

  /// Returns the fault of the next message.
  std::string decode(const std::string& message) {
    return video_.decode("h264", std::as_bytes(std::span(message)), image_);
  }
  void expect_frame(const std::string& message, const Image<Rgb8>& wanted) {
    EXPECT_EQ(decode(message), "");
    EXPECT_TRUE(test::same_pixels(image_.view(), wanted.view()));
  }
  /// Expects frame i of message i, and faults from `first` to the next keyframe.
  void expect_frames(const Messages& messages, const test::ColorFrames& wanted, std::size_t begin,
                     std::size_t first) {
    const std::size_t again = (first / key_every + 1) * key_every;
    for (std::size_t i = begin; i < messages.size(); ++i) {
      SCOPED_TRACE(i);
      if (i >= first && i < again)
        EXPECT_NE(decode(messages[i]), "");
      else
        expect_frame(messages[i], wanted[i]);
    }
  }

  VideoStream video_;
  Image<Rgb8> image_;
};

TEST_F(VideoStreamTest, GivesTheFrameOfEachMessage) {
  const test::ColorFrames frames = moving_frames(40);  // more than frame_num counts
  for (const std::string options :
       {"-bf 0", "-bf 0 -g 1000", "-profile:v baseline -x264-params slices=4",
        "-tune zerolatency -preset ultrafast", "-bf 0 -pix_fmt yuv444p", "-bf 0 -qp 0 -refs 4",
        "-bf 0 -x264-params cqm=jvt:repeat-headers=1"}) {
    SCOPED_TRACE(options);
    const Messages messages = test::h264_messages(frames, options);
    const test::ColorFrames wanted = test::h264_frames(messages, frames[0]);
    VideoStream video;
    for (std::size_t i = 0; i < messages.size(); ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(video.decode("h264", std::as_bytes(std::span(messages[i])), image_), "");
      EXPECT_TRUE(test::same_pixels(image_.view(), wanted[i].view()));
    }
  }
}

TEST_F(VideoStreamTest, AfterALostMessageFramesComeFromTheNextKeyframe) {
  const test::ColorFrames frames = moving_frames(12);
  const Messages messages = test::h264_messages(frames);
  const test::ColorFrames wanted = test::h264_frames(messages, frames[0]);
  for (std::size_t lost = 0; lost < 8; ++lost) {
    SCOPED_TRACE(lost);
    VideoStream video;
    const std::size_t again = (lost / key_every + 1) * key_every;
    for (std::size_t i = 0; i < messages.size(); ++i) {
      if (i == lost) continue;
      const auto fault = video.decode("h264", std::as_bytes(std::span(messages[i])), image_);
      if (i > lost && i < again) {
        EXPECT_HAS(fault, "keyframe");
        continue;
      }
      EXPECT_EQ(fault, "") << i;
      EXPECT_TRUE(test::same_pixels(image_.view(), wanted[i].view())) << i;
    }
  }
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a process is left";
}

TEST_F(VideoStreamTest, BeginsWithTheFirstKeyframe) {
  const test::ColorFrames frames = moving_frames(8);
  const Messages messages = test::h264_messages(frames);
  expect_frames(messages, test::h264_frames(messages, frames[0]), 1, 1);
}

TEST_F(VideoStreamTest, AfterADamagedMessageFramesComeFromTheNextKeyframe) {
  const test::ColorFrames frames = moving_frames(8);
  Messages messages = test::h264_messages(frames);
  const test::ColorFrames wanted = test::h264_frames(messages, frames[0]);
  messages[1].resize(messages[1].size() / 2);
  expect_frames(messages, wanted, 0, 1);
}

TEST_F(VideoStreamTest, MessagesWithoutAFrameAreFaultsOfTheirOwn) {
  const test::ColorFrames frames = moving_frames(8);
  const Messages messages = test::h264_messages(frames);
  const test::ColorFrames wanted = test::h264_frames(messages, frames[0]);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    expect_frame(messages[i], wanted[i]);
    EXPECT_HAS(decode(""), "has 0 frames");
    EXPECT_HAS(decode("no video"), "has 0 frames");
  }
  EXPECT_HAS(decode(messages[0] + messages[1]), "has 2 frames");
}

TEST_F(VideoStreamTest, AnotherSizeBeginsWithAKeyframe) {
  const test::ColorFrames large = moving_frames(2), small = moving_frames(2, 32, 32);
  for (const test::ColorFrames& frames : {large, small, large}) {
    const Messages messages = test::h264_messages(frames);
    const test::ColorFrames wanted = test::h264_frames(messages, frames[0]);
    for (std::size_t i = 0; i < messages.size(); ++i) expect_frame(messages[i], wanted[i]);
  }
}

TEST_F(VideoStreamTest, FramesThatNeedLaterOnesAreRefused) {
  // x264 announces that frames come late; ffmpeg gives none for the first message.
  const Messages messages =
      test::h264_messages(moving_frames(12), "-bf 2 -x264-params b-adapt=0:keyint=12");
  VideoStream video(2'000);
  for (const std::string& message : messages)
    EXPECT_HAS(video.decode("h264", std::as_bytes(std::span(message)), image_), "B-frames");

  // Their headers: frames that are no references do not count.
  int bits = 0;
  std::uint32_t last = 0;
  int between = 0;
  for (const std::string& message : messages) {
    const H264Frame frame = read_h264(message, bits);
    EXPECT_EQ(frame.pictures, 1);
    EXPECT_EQ(frame.is_key, !frame.parameters.empty());
    EXPECT_EQ(frame.number, frame.is_key ? 0 : last + 1);
    if (frame.is_reference) last = frame.number;
    if (frame.is_between) ++between;
    EXPECT_FALSE(frame.is_between && frame.is_reference && frame.is_key);
  }
  EXPECT_GE(between, 6);
}

TEST_F(VideoStreamTest, NeverWaitsForFramesOfDamagedMessages) {
  std::mt19937_64 random = test::seeded_random(42);
  const test::ColorFrames frames = moving_frames(8);
  const Messages whole = test::h264_messages(frames);
  const test::ColorFrames wanted = test::h264_frames(whole, frames[0]);
  for (int round = 0; round < 6; ++round) {
    SCOPED_TRACE(round);
    Messages messages = whole;
    std::string& message = messages[random() % 4];
    for (std::size_t edits = 1 + random() % 8; edits > 0; --edits)
      message[random() % message.size()] = static_cast<char>(random());
    VideoStream video;
    for (std::size_t i = 0; i < messages.size(); ++i) {
      const auto fault = video.decode("h264", std::as_bytes(std::span(messages[i])), image_);
      if (i < 4) continue;
      EXPECT_EQ(fault, "") << i;
      EXPECT_TRUE(test::same_pixels(image_.view(), wanted[i].view())) << i;
    }
  }
}

TEST(VideoStream, OtherFormatsAreRefused) {
  Image<Rgb8> image;
  for (const char* const format : {"h265", "vp9", "av1", ""})
    EXPECT_HAS(VideoStream().decode(format, {}, image),
               "format '" + std::string(format) + "'; expected h264");
}

}  // namespace
}  // namespace penumbra::io
