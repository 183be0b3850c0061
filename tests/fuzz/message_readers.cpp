// SPDX-License-Identifier: Apache-2.0
// Bags and the messages in them. Where a reader has several kinds of messages, the first byte says
// which one the others are; new ones come last, so that the seeds stay as they are.
#include "readers.hpp"

#include <array>
#include <optional>
#include <span>

#include <penumbra/base/error.hpp>

#include <io/bag/bag_file.hpp>
#include <io/mcap/reader.hpp>
#include <io/mcap/writer.hpp>
#include <io/ros/foxglove_messages.hpp>
#include <io/ros/image_codec.hpp>
#include <io/ros/lidar_messages.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/moveit_messages.hpp>
#include <io/ros/restamp.hpp>

namespace penumbra::fuzz {
namespace {

using namespace io;
using Bytes = std::span<const std::byte>;
using Fault = std::optional<std::string>;

/// Reads each byte, so that sanitizers see where it lies.
void touch(Bytes bytes) {
  [[maybe_unused]] static volatile std::byte seen;
  for (const std::byte b : bytes) seen = b;
}

void require_line(const std::string& fault) {
  require(fault.find('\n') == std::string::npos, "a fault is one line");
  require(fault.find("penumbra-bag-") == std::string::npos, "a fault names no temporary file");
}

void read_mcap(std::string_view bytes) {
  mcap::Reader reader(file("a.mcap", bytes));
  for (mcap::Message message; reader.next(message); touch(message.data))
    require(reader.channels().contains(message.channel) && message.log_time >= 0,
            "a message has a channel and a time");
  for (const auto& fault : reader.faults()) require_line(fault.what);
}

void read_bag(const std::filesystem::path& path) {
  const auto bag = open_bag(path);
  for (BagMessage message; bag->next(message); touch(message.data))
    require(message.topic < bag->topics().size(), "a message has a topic");
  for (const std::string& fault : bag->faults()) require_line(fault);
}

Reader bag(const std::string& name, const std::string& path, int trials) {
  return {name, [=](std::string_view bytes) { read_bag(file(path, bytes)); }, trials};
}

/// Of a recording that has one file of its own.
void read_metadata(std::string_view text) {
  const auto metadata = file("bag/metadata.yaml", text);
  static const bool has_file = [&] {
    mcap::Writer writer(metadata.parent_path() / "a.mcap", {.profile = "ros2"});
    const auto schema = writer.add_schema("p/msg/A", "ros2msg", "int32 a\n");
    writer.write(writer.add_channel("/a", "cdr", schema, {}), 1, 1, 0, {});
    writer.close();
    return true;
  }();
  require(has_file, "file");
  read_bag(metadata.parent_path());
}

template <std::size_t N>
Reader one_of(const std::string& name, const std::array<Fault (*)(Bytes), N>& kinds) {
  return {name, [kinds](std::string_view bytes) {
            if (bytes.empty()) return;
            const auto kind = static_cast<unsigned char>(bytes.front()) % N;
            const Fault fault = kinds[kind](std::as_bytes(std::span(bytes.substr(1))));
            if (!fault) return;
            require_line(*fault);
            throw InputError(*fault);
          }};
}

template <typename M>
Fault decode(Bytes bytes) {
  static const Decoder<M> decoder;
  static M message;
  return decoder.decode(bytes, message);
}

constexpr std::array depth_formats{"16UC1; compressedDepth png", "32FC1; compressedDepth png",
                                   "16UC1; compressedDepth rvl", "32FC1; compressedDepth rvl",
                                   "16UC1; png compressed"};
template <int kind>
Fault decode_depth_of(Bytes bytes) {
  static SharedDepth depth;
  return decode_depth(CompressedImageMessage{.format = depth_formats[kind], .data = bytes}, depth);
}

Fault decode_color_of(Bytes bytes) {
  static Image<Rgb8> colors;
  return decode_color(CompressedImageMessage{.format = "any", .data = bytes}, colors);
}

template <typename M, std::size_t N>
Fault decode_protobuf(Bytes bytes, const char (&schema)[N]) {
  static M message;
  return decode_foxglove(schema, bytes, message);
}

void read_definition(std::string_view text) {
  Restamper("a/msg/B", text);
  Decoder<TargetsMessage>("penumbra_msgs/Targets", text);
}

void read_schema(std::string_view descriptors) {
  check_foxglove_schema("foxglove.RawImage", descriptors);
  check_foxglove_schema("foxglove.CameraCalibration", descriptors);
  check_foxglove_schema("foxglove.FrameTransforms", descriptors);
}

const Added messages(
    {{"mcap", read_mcap},
     bag("sqlite", "a.db3", 500),
     bag("zstd", "a.mcap.zstd", 1000),
     {"metadata", read_metadata},
     one_of("ros", std::array{decode<ImageMessage>, decode<CompressedImageMessage>,
                              decode<CameraInfoMessage>, decode<JointStateMessage>,
                              decode<TfMessage>, decode<StringMessage>, decode<PoseStampedMessage>,
                              decode<PointCloud2Message>, decode<LaserScanMessage>,
                              decode<LivoxMessage>, decode<DiagnosticArrayMessage>,
                              decode<KeypointsMessage>, decode<TargetsMessage>,
                              decode<TargetViewsMessage>, decode<Detection2DArrayMessage>,
                              decode<Detection3DArrayMessage>, decode<AttachedObjectMessage>,
                              decode<PlanningSceneMessage>, decode<DisplayTrajectoryMessage>}),
     one_of("ros_images", std::array{decode_depth_of<0>, decode_depth_of<1>, decode_depth_of<2>,
                                     decode_depth_of<3>, decode_depth_of<4>, decode_color_of}),
     {"ros_definition", read_definition},
     one_of("foxglove",
            std::array<Fault (*)(Bytes), 6>{
                [](Bytes b) { return decode_protobuf<ImageMessage>(b, "foxglove.RawImage"); },
                [](Bytes b) {
                  return decode_protobuf<CompressedImageMessage>(b, "foxglove.CompressedImage");
                },
                [](Bytes b) {
                  return decode_protobuf<CameraInfoMessage>(b, "foxglove.CameraCalibration");
                },
                [](Bytes b) {
                  return decode_protobuf<JointStateMessage>(b, "foxglove.JointStates");
                },
                [](Bytes b) { return decode_protobuf<TfMessage>(b, "foxglove.FrameTransforms"); },
                [](Bytes b) { return decode_protobuf<TfMessage>(b, "foxglove.FrameTransform"); }}),
     {"foxglove_schema", read_schema}});

}  // namespace
}  // namespace penumbra::fuzz
