// SPDX-License-Identifier: Apache-2.0
// The messages of a bag that others wrote, by its own definitions, against the recording they are
// of.
#include "../support/data.hpp"

#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include <io/mcap/reader.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/message_decoder.hpp>

namespace penumbra::io {
namespace {

constexpr std::size_t frames = 10;

class RosRecording : public testing::Test {
 protected:
  /// Calls `call` with each message of a topic.
  template <typename M, typename F>
  void for_each(const std::string& topic, const F& call) {
    mcap::Reader reader(folder_ / "xarm7.mcap");
    std::optional<Decoder<M>> decoder;
    mcap::Message message;
    M decoded;
    while (reader.next(message)) {
      const mcap::Channel& channel = reader.channels().at(message.channel);
      if (channel.topic != topic) continue;
      const mcap::Schema& schema = reader.schemas().at(channel.schema_id);
      if (!decoder) decoder.emplace(schema.name, schema.data);
      const auto fault = decoder->decode(message.data, decoded);
      ASSERT_FALSE(fault) << *fault;
      call(decoded);
    }
    EXPECT_TRUE(reader.faults().empty());
  }

  std::filesystem::path folder_ = test::data_folder() / "xarm7_realsense";
};

TEST_F(RosRecording, DepthImagesAreTheRecordings) {
  PENUMBRA_REQUIRE_DATA();
  std::size_t index = 0;
  for_each<ImageMessage>("/camera/aligned_depth_to_color/image_raw", [&](const auto& message) {
    EXPECT_EQ(message.header.frame_id, "camera_color_optical_frame");
    DecodedDepth depth;
    const auto fault = decode_depth(message, depth);
    ASSERT_FALSE(fault) << *fault;
    const auto view = std::get<ImageView<const std::uint16_t>>(depth.view);
    Image<std::uint16_t> wanted;
    read_png(folder_ / ("depth_" + std::to_string(index++) + ".png"), wanted).require();
    ASSERT_EQ(view.width, wanted.width());
    for (int v = 0; v < view.height; ++v)
      ASSERT_EQ(std::memcmp(view.row(v), wanted.view().row(v), 2U * 1280), 0) << v;
  });
  EXPECT_EQ(index, frames);
}

TEST_F(RosRecording, ColourImagesAreTheRecordings) {
  PENUMBRA_REQUIRE_DATA();
  std::size_t index = 0;
  for_each<CompressedImageMessage>("/camera/color/image_raw/compressed", [&](const auto& message) {
    Image<Rgb8> image, wanted;
    const auto fault = decode_colour(message, image);
    ASSERT_FALSE(fault) << *fault;
    read_png(folder_ / ("color_" + std::to_string(index++) + ".png"), wanted).require();
    ASSERT_EQ(image.size(), wanted.size());
    EXPECT_EQ(std::memcmp(image.data(), wanted.data(), 3 * image.size()), 0) << index;
  });
  EXPECT_EQ(index, frames);
}

TEST_F(RosRecording, TheRestIsRead) {
  PENUMBRA_REQUIRE_DATA();
  std::size_t states = 0, infos = 0, transforms = 0, robots = 0;
  std::int64_t last = 0;
  for_each<JointStateMessage>("/joint_states", [&](const auto& message) {
    EXPECT_EQ(message.names.size(), 7U);
    EXPECT_EQ(message.positions.size(), 7U);
    EXPECT_GT(message.header.stamp, last);
    last = message.header.stamp;
    ++states;
  });
  for_each<CameraInfoMessage>("/camera/aligned_depth_to_color/camera_info", [&](const auto& info) {
    EXPECT_EQ(info.width, 1280U);
    EXPECT_EQ(info.k[8], 1.0);
    ++infos;
  });
  for_each<TfMessage>("/tf_static", [&](const auto& message) {
    for (const TransformMessage& transform : message.transforms) {
      EXPECT_TRUE(transform.T_parent_child.matrix().allFinite()) << transform.child_frame_id;
      ++transforms;
    }
  });
  for_each<StringMessage>("/robot_description", [&](const auto& message) {
    EXPECT_NE(message.data.find("<robot name=\"xarm7\">"), std::string::npos);
    ++robots;
  });
  EXPECT_GT(states, 1000U);
  EXPECT_EQ(infos, frames);
  EXPECT_EQ(transforms, 2U);
  EXPECT_EQ(robots, 1U);
}

}  // namespace
}  // namespace penumbra::io
