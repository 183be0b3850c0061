// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include <penumbra/base/error.hpp>

#include <io/files/printable.hpp>
#include <io/ros/cdr_reader.hpp>
#include <io/ros/message_decoder.hpp>
#include <io/ros/wire_types-inl.hpp>

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

template <WireMessage M>
void read_value(CdrReader& reader, M& message);

template <typename T>
void read_value(CdrReader& reader, std::vector<T>& values) {
  if constexpr (std::is_arithmetic_v<T>) {
    values.resize(reader.read_count(sizeof(T)));
    reader.read_array(values.data(), values.size());
  } else {
    // Grows as it reads: a false count allocates no more than the payload can hold.
    const std::size_t count = reader.read_count(1);
    for (std::size_t i = 0; i < count && reader.ok(); ++i) {
      if (i == values.size()) values.emplace_back();
      read_value(reader, values[i]);
    }
    values.resize(reader.ok() ? count : 0);
  }
}

template <typename M, typename T>
void read_member(CdrReader& reader, M& message, const Member<M, T>& member) {
  read_value(reader, message.*member.at);
}

template <typename W, typename M, typename T>
void read_member(CdrReader& reader, M& message, const Converted<W, M, T>& member) {
  W wire;
  read_value(reader, wire);
  if (const char* fault = from_wire(wire, message.*member.at); fault != nullptr) reader.fail(fault);
  if constexpr (std::is_same_v<M, MessageHeader>) message.stamp_at = reader.at() - sizeof(wire);
}

template <WireMessage M>
void read_value(CdrReader& reader, M& message) {
  for_each_member<M>([&](const auto& member) {
    if (!reader.ok()) return;
    read_member(reader, message, member);
    if (!reader.ok()) reader.locate(std::string(member.name));
  });
}

}  // namespace

template <typename M>
std::string layout_difference(const MessageDefinition& definition) {
  MessageFields expected{.type = std::string(Fields<M>::type)};
  std::string nested;
  for_each_member<M>([&](const auto& member) {
    using Type = decltype(wire_type(member));
    expected.fields.push_back((Type::text() + " ").append(member.name));
    if constexpr (WireMessage<typename Type::Value>)
      if (nested.empty()) nested = layout_difference<typename Type::Value>(definition);
  });
  const std::string own = definition.difference(expected);
  return own.empty() ? nested : own;
}

template <typename M>
Decoder<M>::Decoder(std::string_view type, std::string_view definition) {
  const std::string wanted(Fields<M>::type);
  if (short_type(type) != wanted)
    throw InputError("messages of type '" + printable(type) + "' cannot be read as " + wanted);
  const std::string difference = layout_difference<M>(MessageDefinition(type, definition));
  if (!difference.empty())
    throw InputError("message definition of '" + wanted + "': " + difference +
                     "; messages are read as ROS 2 Humble defines them");
}

template <typename M>
std::optional<std::string> Decoder<M>::decode(std::span<const std::byte> payload,
                                              M& message) const {
  CdrReader reader(payload);
  if (reader.ok()) read_value(reader, message);
  if (reader.remaining() > most_padding)
    reader.fail(std::to_string(reader.remaining()) +
                " bytes are left over: the definition is not this message's");
  if (reader.ok()) return std::nullopt;
  return std::string(Fields<M>::type) + ": " + reader.fault();
}

template <typename M>
std::string message_type() {
  std::string type(Fields<M>::type);
  return type.replace(type.find('/'), 1, "/msg/");
}

template class Decoder<ImageMessage>;
template class Decoder<CompressedImageMessage>;
template class Decoder<CameraInfoMessage>;
template class Decoder<JointStateMessage>;
template class Decoder<TfMessage>;
template class Decoder<StringMessage>;
template class Decoder<PoseStampedMessage>;
template class Decoder<Detection2DArrayMessage>;
template class Decoder<Detection3DArrayMessage>;
template class Decoder<PointCloud2Message>;
template class Decoder<DiagnosticArrayMessage>;
template class Decoder<KeypointsMessage>;
template class Decoder<TargetsMessage>;

template std::string message_type<ImageMessage>();
template std::string message_type<CompressedImageMessage>();
template std::string message_type<CameraInfoMessage>();
template std::string message_type<JointStateMessage>();
template std::string message_type<TfMessage>();
template std::string message_type<StringMessage>();
template std::string message_type<PoseStampedMessage>();
template std::string message_type<Detection2DArrayMessage>();
template std::string message_type<Detection3DArrayMessage>();
template std::string message_type<PointCloud2Message>();
template std::string message_type<DiagnosticArrayMessage>();
template std::string message_type<KeypointsMessage>();
template std::string message_type<TargetsMessage>();

template std::string layout_difference<MessageHeader>(const MessageDefinition&);
template std::string layout_difference<TfMessage>(const MessageDefinition&);
template std::string layout_difference<Detection2DArrayMessage>(const MessageDefinition&);
template std::string layout_difference<Detection3DArrayMessage>(const MessageDefinition&);

}  // namespace penumbra::io
