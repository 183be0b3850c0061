// SPDX-License-Identifier: Apache-2.0
// Reads protobuf into structs. A struct's fields(io) passes number, name and place of each field
// that is read to `io`; fields that it does not name are left out. `full_name` is the message's.
// finish(), if a struct has it, is called when all fields are read, and returns what is wrong or an
// empty text.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <io/files/printable.hpp>
#include <io/ros/protobuf_reader.hpp>

namespace penumbra::io::protobuf {

/// A type's number in google/protobuf/descriptor.proto, and its form on the wire.
struct Kind {
  int type = 11;  ///< a message
  ProtobufWire wire = ProtobufWire::bytes;
};
template <typename T>
constexpr Kind kind_of = {};
template <>
inline constexpr Kind kind_of<double> = {1, ProtobufWire::fixed64};
template <>
inline constexpr Kind kind_of<std::int64_t> = {3, ProtobufWire::varint};
template <>
inline constexpr Kind kind_of<std::int32_t> = {5, ProtobufWire::varint};
template <>
inline constexpr Kind kind_of<std::uint32_t> = {7, ProtobufWire::fixed32};
template <>
inline constexpr Kind kind_of<std::string> = {9, ProtobufWire::bytes};
template <>
inline constexpr Kind kind_of<std::span<const std::byte>> = {12, ProtobufWire::bytes};
template <>
inline constexpr Kind kind_of<std::uint8_t> = {14, ProtobufWire::varint};  // an enumeration

/// A field's type without its list or optional.
template <typename T>
struct Element {
  using Type = T;
  static constexpr bool is_list = false;
};
template <typename T>
struct Element<std::optional<T>> : Element<T> {};
template <typename T>
struct Element<std::vector<T>> : Element<T> {
  static constexpr bool is_list = true;
};

template <typename S>
std::string read(std::span<const std::byte> bytes, S& message);

template <typename T>
std::string read_value(const ProtobufField& field, T& value) {
  if (field.wire != kind_of<T>.wire)
    return "is of wire type " + std::to_string(static_cast<int>(field.wire));
  if constexpr (std::is_same_v<T, double>)
    value = std::bit_cast<double>(field.bits);
  else if constexpr (std::is_integral_v<T>)
    value = static_cast<T>(field.bits);
  else if constexpr (std::is_same_v<T, std::string>)
    value.assign(reinterpret_cast<const char*>(field.bytes.data()), field.bytes.size());
  else if constexpr (std::is_same_v<T, std::span<const std::byte>>)
    value = field.bytes;
  else
    return read(field.bytes, value);
  return {};
}

template <typename T>
std::string read_value(const ProtobufField& field, std::optional<T>& value) {
  if (!value) value.emplace();
  return read_value(field, *value);
}

/// Messages of two bytes may be of hundreds in memory.
inline constexpr std::size_t most_elements = 65'536;

template <typename T>
std::string read_value(const ProtobufField& field, std::vector<T>& values) {
  if (values.size() == most_elements) return "has more than 65536 elements";
  return read_value(field, values.emplace_back());
}

/// Numbers lie each on its own or packed.
inline std::string read_value(const ProtobufField& field, std::vector<double>& values) {
  if (field.wire != ProtobufWire::bytes) return read_value(field, values.emplace_back());
  const std::size_t before = values.size(), count = field.bytes.size() / sizeof(double);
  if (field.bytes.size() % sizeof(double) != 0)
    return "has " + std::to_string(field.bytes.size()) + " bytes of numbers of 8";
  values.resize(before + count);
  if (count > 0) std::memcpy(values.data() + before, field.bytes.data(), field.bytes.size());
  return {};
}

struct FieldReader {
  const ProtobufField& field;
  std::string fault = {};

  template <typename T>
  void operator()(std::uint32_t number, const char* name, T& value) {
    if (number != field.number) return;
    fault = read_value(field, value);
    if (!fault.empty()) fault.insert(0, std::string(name) + ": ");
  }
};

/// Reads a message. Returns what is wrong, one line, or an empty text. Fields may come in any
/// order; of a field that comes twice the last counts, and messages are merged, as protobuf says.
template <typename S>
std::string read(std::span<const std::byte> bytes, S& message) {
  ProtobufReader reader(bytes);
  for (ProtobufField field; reader.next(field);) {
    FieldReader place{field};
    message.fields(place);
    if (!place.fault.empty()) return place.fault;
  }
  if (!reader.fault().empty()) return reader.fault();
  if constexpr (requires { message.finish(); }) return message.finish();
  return {};
}

// Schemas of schemas: google/protobuf/descriptor.proto.

struct DescribedField {
  void fields(auto& io) {
    io(1, "name", name);
    io(3, "number", number);
    io(4, "label", label);
    io(5, "type", type);
  }

  static constexpr std::uint8_t repeated = 3;  // a label

  std::string name = {};
  std::int32_t number = 0;
  std::uint8_t label = 0, type = 0;
};

struct DescribedMessage {
  void fields(auto& io) {
    io(1, "name", name);
    io(2, "field", members);
  }

  std::string name = {};
  std::vector<DescribedField> members = {};
};

struct DescribedFile {
  void fields(auto& io) {
    io(2, "package", package);
    io(4, "message_type", messages);
  }

  std::string package = {};
  std::vector<DescribedMessage> messages = {};
};

/// A FileDescriptorSet.
struct DescribedFiles {
  void fields(auto& io) { io(1, "file", files); }

  [[nodiscard]] const DescribedMessage* find(std::string_view full_name) const {
    for (const DescribedFile& file : files)
      for (const DescribedMessage& message : file.messages)
        if (file.package + "." + message.name == full_name) return &message;
    return nullptr;
  }

  std::vector<DescribedFile> files = {};
};

template <typename S>
std::string difference(const DescribedFiles& described);

struct FieldCheck {
  const DescribedFiles& described;
  const DescribedMessage& owner;
  std::string found = {};

  template <typename T>
  void operator()(std::int32_t number, const std::string& name, T& /*value*/) {
    using Type = typename Element<T>::Type;
    if (!found.empty()) return;
    const auto at = std::ranges::find(owner.members, number, &DescribedField::number);
    const std::string field = "field " + std::to_string(number) + " of " + owner.name;
    if (at == owner.members.end())
      found = field + " is missing; expected " + name;
    else if (at->name != name)
      found = field + " is '" + printable(at->name) + "'; expected " + name;
    else if (at->type != kind_of<Type>.type ||
             (at->label == DescribedField::repeated) != Element<T>::is_list)
      found = field + ", " + name + ", is of another type";
    else if constexpr (kind_of<Type>.type == Kind().type)
      found = difference<Type>(described);
  }
};

/// Returns the first difference of a bag's schemas from the fields that S and its parts read, or an
/// empty text.
template <typename S>
std::string difference(const DescribedFiles& described) {
  const DescribedMessage* message = described.find(S::full_name);
  if (message == nullptr) return "lacks " + std::string(S::full_name);
  FieldCheck check{described, *message};
  S places;
  places.fields(check);
  return check.found;
}

}  // namespace penumbra::io::protobuf
