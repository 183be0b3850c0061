// SPDX-License-Identifier: Apache-2.0
// Writes messages of Foxglove's schemas, and the schemas themselves, byte by byte from protobuf's
// encoding (https://protobuf.dev/programming-guides/encoding) and the public .proto files.
#pragma once

#include "files.hpp"

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <io/ros/foxglove_messages.hpp>

namespace penumbra::test::foxglove {

inline std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value > 127; value >>= 7) bytes += static_cast<char>(value | 128);
  return bytes + static_cast<char>(value);
}

// A field of each form; `at`: its number.
inline std::string integer(int at, std::uint64_t value) {
  return varint(static_cast<std::uint64_t>(at) << 3) + varint(value);
}
inline std::string real(int at, double value) {
  return varint(static_cast<std::uint64_t>(at) << 3 | 1) + raw(value);
}
inline std::string counted(int at, const std::string& bytes) {
  return varint(static_cast<std::uint64_t>(at) << 3 | 2) + varint(bytes.size()) + bytes;
}
inline std::string fixed(int at, std::uint32_t value) {
  return varint(static_cast<std::uint64_t>(at) << 3 | 5) + raw(value);
}
inline std::string packed(int at, std::span<const double> values) {
  std::string bytes;
  for (const double value : values) bytes += raw(value);
  return counted(at, bytes);
}

inline std::string bytes_in(std::span<const std::byte> data) {
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}
inline std::string time(std::int64_t stamp) {
  return integer(1, static_cast<std::uint64_t>(stamp / 1'000'000'000)) +
         integer(2, static_cast<std::uint64_t>(stamp % 1'000'000'000));
}

inline std::string encode(const io::ImageMessage& image) {
  return counted(1, time(image.header.stamp)) + counted(7, image.header.frame_id) +
         fixed(2, image.width) + fixed(3, image.height) + counted(4, image.encoding) +
         fixed(5, image.step) + counted(6, bytes_in(image.data));
}

inline std::string encode(const io::CompressedImageMessage& image) {
  return counted(1, time(image.header.stamp)) + counted(4, image.header.frame_id) +
         counted(2, bytes_in(image.data)) + counted(3, image.format);
}

inline std::string encode(const io::CompressedVideoMessage& video) {
  return counted(1, time(video.header.stamp)) + counted(2, video.header.frame_id) +
         counted(3, bytes_in(video.data)) + counted(4, video.format);
}

inline std::string encode(const io::CameraInfoMessage& info) {
  return counted(1, time(info.header.stamp)) + counted(9, info.header.frame_id) +
         fixed(2, info.width) + fixed(3, info.height) + counted(4, info.distortion_model) +
         packed(5, info.d) + packed(6, info.k) + packed(7, info.r) + packed(8, info.p);
}

inline std::string encode(const io::JointStateMessage& state) {
  std::string bytes = counted(1, time(state.header.stamp));
  for (std::size_t i = 0; i < state.names.size(); ++i)
    bytes += counted(2, counted(1, state.names[i]) + real(2, state.positions[i]));
  return bytes;
}

inline std::string encode(const io::TransformMessage& transform) {
  const Eigen::Vector3d t = transform.T_parent_child.translation();
  const Eigen::Quaterniond q(transform.T_parent_child.linear());
  return counted(1, time(transform.header.stamp)) + counted(2, transform.header.frame_id) +
         counted(3, transform.child_frame_id) +
         counted(4, real(1, t.x()) + real(2, t.y()) + real(3, t.z())) +
         counted(5, real(1, q.x()) + real(2, q.y()) + real(3, q.z()) + real(4, q.w()));
}

inline std::string encode(const io::TfMessage& tf) {
  std::string bytes;
  for (const io::TransformMessage& transform : tf.transforms)
    bytes += counted(1, encode(transform));
  return bytes;
}

/// Package and name of each message; then number, name, label (1 optional, 3 repeated) and type (by
/// google/protobuf/descriptor.proto) of each field.
inline const std::string all_schemas = R"(
google.protobuf Timestamp
1 seconds 1 3
2 nanos 1 5
foxglove Vector3
1 x 1 1
2 y 1 1
3 z 1 1
foxglove Quaternion
1 x 1 1
2 y 1 1
3 z 1 1
4 w 1 1
foxglove RawImage
1 timestamp 1 11
7 frame_id 1 9
2 width 1 7
3 height 1 7
4 encoding 1 9
5 step 1 7
6 data 1 12
foxglove CompressedImage
1 timestamp 1 11
4 frame_id 1 9
2 data 1 12
3 format 1 9
100 message_id 1 9
foxglove CompressedVideo
1 timestamp 1 11
2 frame_id 1 9
3 data 1 12
4 format 1 9
foxglove CameraCalibration
1 timestamp 1 11
9 frame_id 1 9
2 width 1 7
3 height 1 7
4 distortion_model 1 9
5 D 3 1
6 K 3 1
7 R 3 1
8 P 3 1
foxglove FrameTransform
1 timestamp 1 11
2 parent_frame_id 1 9
3 child_frame_id 1 9
4 translation 1 11
5 rotation 1 11
foxglove FrameTransforms
1 transforms 3 11
foxglove JointState
1 name 1 9
2 position 1 1
3 velocity 1 1
4 acceleration 1 1
5 effort 1 1
foxglove JointStates
1 timestamp 1 11
2 joints 3 11
)";

/// Returns the FileDescriptorSet of such a table, a file for each message.
inline std::string descriptors(const std::string& table = all_schemas) {
  std::istringstream lines(table);
  std::string set, package, name, message;
  const auto end_message = [&] {
    if (!name.empty())
      set += counted(1, counted(1, name + ".proto") + counted(2, package) +
                            counted(4, counted(1, name) + message));
    message.clear();
  };
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    int number = 0;
    if (words >> number) {
      std::string field;
      std::uint64_t label = 0, type = 0;
      words >> field >> label >> type;
      message += counted(2, counted(1, field) + integer(3, static_cast<std::uint64_t>(number)) +
                                integer(4, label) + integer(5, type));
    } else if (!line.empty()) {
      end_message();
      words.clear();
      words.seekg(0);
      words >> package >> name;
    }
  }
  end_message();
  return set;
}

}  // namespace penumbra::test::foxglove
