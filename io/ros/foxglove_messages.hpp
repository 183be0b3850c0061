// SPDX-License-Identifier: Apache-2.0
// Messages of Foxglove's schemas in protobuf (https://docs.foxglove.dev/docs/sdk/schemas), read as
// the messages of ROS 2 that say the same.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// One frame of a video, which most often needs the frames before it. ROS 2 has it, too.
struct CompressedVideoMessage {
  static constexpr std::string_view ros_type = "foxglove_msgs/CompressedVideo";
  static auto layout(auto& m) {
    return fields_of(as<TimeWire>(m.header.stamp), m.header.frame_id, m.data, m.format);
  }

  MessageHeader header = {};
  std::span<const std::byte> data = {};
  std::string format = {};  ///< "h264"
};

/// Returns the type of ROS 2 that messages of a type are read as: "sensor_msgs/msg/Image" for
/// "foxglove.RawImage", and other names unchanged.
[[nodiscard]] std::string ros_type_of(std::string_view type);

/// Returns whether messages of this type and encoding can be read: CDR, or protobuf of a schema
/// that ros_type_of() knows.
[[nodiscard]] bool is_readable(std::string_view type, std::string_view encoding);

/// Throws InputError that names the field if a bag's schema lacks a field that is read, or has it
/// with another number or type. `descriptors`: google.protobuf.FileDescriptorSet, as in MCAP files.
void check_foxglove_schema(std::string_view schema, std::string_view descriptors);

template <typename M, typename... Types>
constexpr bool is_one_of_types = (std::is_same_v<M, Types> || ...);
/// Whether a schema is read as M.
template <typename M>
constexpr bool is_in_foxglove =
    is_one_of_types<M, ImageMessage, CompressedImageMessage, CompressedVideoMessage,
                    CameraInfoMessage, JointStateMessage, TfMessage>;

/// Reads a message of a schema whose ros_type_of() is M's. Returns what is wrong, one line that
/// names the schema and the field, or nothing; after a fault the message is unspecified. Spans of
/// the message refer to the payload. Images and joint states need a timestamp. Joints without a
/// position are left out.
template <typename M>
[[nodiscard]] std::optional<std::string> decode_foxglove(std::string_view schema,
                                                         std::span<const std::byte> payload,
                                                         M& message);

}  // namespace penumbra::io
