// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include <io/ros/cdr_writer.hpp>
#include <io/ros/foxglove_messages.hpp>
#include <io/ros/lidar_messages.hpp>
#include <io/ros/message_encoder.hpp>
#include <io/ros/moveit_messages.hpp>
#include <io/ros/wire_values.hpp>

namespace penumbra::io {
namespace {

void write_value(CdrWriter& writer, bool value) { writer.write_bool(value); }

void write_value(CdrWriter& writer, const std::string& text) { writer.write_string(text); }

void write_value(CdrWriter& writer, std::span<const std::byte> bytes) {
  writer.write_count(bytes.size());
  writer.write_array(bytes.data(), bytes.size());
}

template <typename T>
requires std::is_arithmetic_v<T>
void write_value(CdrWriter& writer, T number) { writer.write(number); }

template <typename T, std::size_t N>
void write_value(CdrWriter& writer, const std::array<T, N>& numbers) {
  writer.write_array(numbers.data(), N);
}

template <typename M>
requires requires { M::ros_type; }
void write_value(CdrWriter& writer, const M& message);

template <typename T>
void write_value(CdrWriter& writer, const std::vector<T>& values) {
  writer.write_count(values.size());
  for (const T& value : values) write_value(writer, value);
}

template <typename W, typename T>
void write_value(CdrWriter& writer, const Converted<W, T>& field) {
  W wire;
  to_wire(field.value, wire);
  write_value(writer, wire);
}

template <typename M>
requires requires { M::ros_type; }
void write_value(CdrWriter& writer, const M& message) {
  std::apply([&](const auto&... values) { (write_value(writer, values), ...); },
             M::layout(message));
}

}  // namespace

template <typename M>
void encode(const M& message, std::vector<std::byte>& payload) {
  CdrWriter writer(payload);
  write_value(writer, message);
}

template void encode(const ImageMessage&, std::vector<std::byte>&);
template void encode(const CompressedImageMessage&, std::vector<std::byte>&);
template void encode(const CompressedVideoMessage&, std::vector<std::byte>&);
template void encode(const CameraInfoMessage&, std::vector<std::byte>&);
template void encode(const JointStateMessage&, std::vector<std::byte>&);
template void encode(const TfMessage&, std::vector<std::byte>&);
template void encode(const StringMessage&, std::vector<std::byte>&);
template void encode(const PoseStampedMessage&, std::vector<std::byte>&);
template void encode(const PointCloud2Message&, std::vector<std::byte>&);
template void encode(const LaserScanMessage&, std::vector<std::byte>&);
template void encode(const LivoxMessage&, std::vector<std::byte>&);
template void encode(const DiagnosticArrayMessage&, std::vector<std::byte>&);
template void encode(const KeypointsMessage&, std::vector<std::byte>&);
template void encode(const TargetsMessage&, std::vector<std::byte>&);
template void encode(const TargetViewsMessage&, std::vector<std::byte>&);
template void encode(const AttachedObjectMessage&, std::vector<std::byte>&);
template void encode(const PlanningSceneMessage&, std::vector<std::byte>&);
template void encode(const JointTrajectoryMessage&, std::vector<std::byte>&);
template void encode(const DisplayTrajectoryMessage&, std::vector<std::byte>&);

}  // namespace penumbra::io
