// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include <penumbra/base/error.hpp>

#include <io/files/printable.hpp>
#include <io/ros/cdr_reader.hpp>
#include <io/ros/foxglove_messages.hpp>
#include <io/ros/lidar_messages.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/message_definition.hpp>
#include <io/ros/moveit_messages.hpp>
#include <io/ros/wire_values.hpp>

namespace penumbra::io {
namespace {

// DDS fills payloads up to a multiple of four bytes.
constexpr std::size_t most_padding = 3;

void read_value(CdrReader& reader, bool& value) { value = reader.read_bool(); }

void read_value(CdrReader& reader, std::string& text) { text = reader.read_string(); }

void read_value(CdrReader& reader, std::span<const std::byte>& bytes) {
  bytes = reader.read_octets(reader.read_count(1));
}

template <typename T>
requires std::is_arithmetic_v<T>
void read_value(CdrReader& reader, T& number) { number = reader.read<T>(); }

template <typename T, std::size_t N>
void read_value(CdrReader& reader, std::array<T, N>& numbers) {
  reader.read_array(numbers.data(), N);
}

template <typename M>
requires requires { M::ros_type; }
void read_value(CdrReader& reader, M& message);

template <typename T>
void read_value(CdrReader& reader, std::vector<T>& values) {
  if constexpr (std::is_arithmetic_v<T>) {
    values.resize(reader.read_count(sizeof(T)));
    reader.read_array(values.data(), values.size());
  } else {
    // Grows while it reads, so that a false count allocates no more than the payload can hold.
    const std::size_t count = reader.read_count(1);
    for (std::size_t i = 0; i < count && reader.ok(); ++i) {
      if (i == values.size()) values.emplace_back();
      read_value(reader, values[i]);
    }
    values.resize(reader.ok() ? count : 0);
  }
}

template <typename W, typename T>
void read_value(CdrReader& reader, const Converted<W, T>& field) {
  W wire;
  read_value(reader, wire);
  if (const char* fault = from_wire(wire, field.value); fault != nullptr) reader.fail(fault);
}

std::string field_name(std::string_view type, std::size_t i) {
  const MessageDefinition definition(type, definition_of(type));
  const std::string& field = definition.types().front().fields.at(i);
  return field.substr(field.find(' ') + 1);
}

template <typename M>
requires requires { M::ros_type; }
void read_value(CdrReader& reader, M& message) {
  if constexpr (std::is_same_v<M, MessageHeader>) message.stamp_at = (reader.at() + 3) / 4 * 4;
  std::size_t field = 0;
  const auto read_field = [&](auto&& value) {
    if (!reader.ok()) return;
    read_value(reader, value);
    if (!reader.ok()) reader.locate(field_name(M::ros_type, field));
    ++field;
  };
  std::apply([&](auto&&... values) { (read_field(values), ...); }, M::layout(message));
}

}  // namespace

template <typename M>
Decoder<M>::Decoder(std::string_view type, std::string_view definition) {
  const std::string wanted(M::ros_type);
  if constexpr (is_in_foxglove<M>) {
    if (type != ros_type_of(type) && ros_type_of(type) == message_type<M>()) {
      check_foxglove_schema(type, definition);
      foxglove_ = type;
      return;
    }
  }
  if (short_type(type) != wanted)
    throw InputError("messages of type '" + printable(type) + "' cannot be read as " + wanted);
  const std::string difference =
      difference_from_built_in(MessageDefinition(type, definition), wanted);
  if (!difference.empty())
    throw InputError("message definition of '" + wanted + "': " + difference +
                     "; messages are read as ROS 2 Humble defines them");
}

template <typename M>
std::optional<std::string> Decoder<M>::decode(std::span<const std::byte> payload,
                                              M& message) const {
  if constexpr (is_in_foxglove<M>)
    if (!foxglove_.empty()) return decode_foxglove(foxglove_, payload, message);
  CdrReader reader(payload);
  if (reader.ok()) read_value(reader, message);
  constexpr bool is_beginning = requires { M::is_beginning; };
  if (!is_beginning && reader.remaining() > most_padding)
    reader.fail(std::to_string(reader.remaining()) +
                " bytes are left over: the definition is not this message's");
  if (reader.ok()) return std::nullopt;
  return std::string(M::ros_type) + ": " + reader.fault();
}

template class Decoder<ImageMessage>;
template class Decoder<CompressedImageMessage>;
template class Decoder<CompressedVideoMessage>;
template class Decoder<CameraInfoMessage>;
template class Decoder<JointStateMessage>;
template class Decoder<TfMessage>;
template class Decoder<StringMessage>;
template class Decoder<PoseStampedMessage>;
template class Decoder<Detection2DArrayMessage>;
template class Decoder<Detection3DArrayMessage>;
template class Decoder<PointCloud2Message>;
template class Decoder<LaserScanMessage>;
template class Decoder<LivoxMessage>;
template class Decoder<DiagnosticArrayMessage>;
template class Decoder<KeypointsMessage>;
template class Decoder<TargetsMessage>;
template class Decoder<TargetViewsMessage>;
template class Decoder<AttachedObjectMessage>;
template class Decoder<PlanningSceneMessage>;
template class Decoder<JointTrajectoryMessage>;
template class Decoder<DisplayTrajectoryMessage>;

}  // namespace penumbra::io
