// SPDX-License-Identifier: Apache-2.0
#include <penumbra/base/error.hpp>

#include <io/ros/cdr_fields.hpp>

namespace penumbra::io {
namespace {

using Types = std::vector<TypeDefinition>;

// Bytes of a number; 0 for what is none.
std::size_t number_bytes(WireType type) {
  switch (type) {
    case WireType::octet:
    case WireType::int8:
      return 1;
    case WireType::int16:
    case WireType::uint16:
      return 2;
    case WireType::int32:
    case WireType::uint32:
    case WireType::float32:
      return 4;
    case WireType::int64:
    case WireType::uint64:
    case WireType::float64:
      return 8;
    default:
      return 0;
  }
}

void skip_value(CdrReader& reader, const FieldDefinition& field, const Types& types) {
  if (field.type == WireType::boolean) {
    static_cast<void>(reader.read_bool());
  } else if (field.type == WireType::string) {
    static_cast<void>(reader.read_string());
  } else if (types[field.nested].fields.empty()) {
    reader.skip_array(1, 1);
  } else {
    for (const FieldDefinition& inner : types[field.nested].fields)
      skip_field(reader, inner, types);
  }
}

}  // namespace

std::size_t count_values(CdrReader& reader, const FieldDefinition& field, std::size_t min_bytes) {
  if (field.arity == Arity::one) return 1;
  if (field.arity == Arity::array) {
    if (field.count <= reader.remaining() / min_bytes) return field.count;
    reader.fail("an array of " + std::to_string(field.count) + " is wanted where " +
                std::to_string(reader.remaining()) + " bytes are left");
    return 0;
  }
  const std::size_t count = reader.read_count(min_bytes);
  if (field.count > 0 && count > field.count)
    reader.fail(std::to_string(count) + " elements in a sequence of at most " +
                std::to_string(field.count));
  return reader.ok() ? count : 0;
}

void skip_field(CdrReader& reader, const FieldDefinition& field, const Types& types) {
  const std::size_t count = count_values(reader, field, min_bytes_each(field, types));
  if (const std::size_t bytes = number_bytes(field.type); bytes > 0) {
    reader.skip_array(count, bytes);
  } else {
    for (std::size_t i = 0; i < count && reader.ok(); ++i) skip_value(reader, field, types);
  }
  if (!reader.ok()) reader.locate(field.name);
}

void refuse_wstrings(const MessageDefinition& definition) {
  for (const TypeDefinition& type : definition.types())
    for (const FieldDefinition& field : type.fields)
      if (field.type == WireType::wstring)
        throw InputError("message definition of '" + definition.root().name + "': " + type.name +
                         " has " + field.name +
                         " as wstring, whose encoding differs between DDS vendors");
}

}  // namespace penumbra::io
