// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <nettle/base16.h>
#include <nettle/sha2.h>

#include <io/dds/type_hash.hpp>
#include <io/ros/message_definition.hpp>

namespace penumbra::io {
namespace {

// Numbers of type_description_interfaces/msg/FieldType.
constexpr int nested_type = 1;
const std::map<std::string_view, int> built_in_types = {
    {"int8", 2},   {"uint8", 3}, {"int16", 4},   {"uint16", 5},   {"int32", 6},
    {"uint32", 7}, {"int64", 8}, {"uint64", 9},  {"float32", 10}, {"float64", 11},
    {"bool", 15},  {"byte", 16}, {"string", 17}, {"wstring", 18}};
constexpr int bounded_string = 4;  // these are added to a type's number
constexpr int array = 48, bounded_sequence = 96, unbounded_sequence = 144;

/// "std_msgs/msg/Header" for "std_msgs/Header".
std::string full_name(std::string name) {
  const std::size_t slash = name.find('/');
  return slash == std::string::npos ? name : name.replace(slash, 1, "/msg/");
}

/// The digits after `mark`, or "0".
std::string number_after(std::string_view text, std::string_view mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return "0";
  text.remove_prefix(at + mark.size());
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  return digits == 0 ? "0" : std::string(text.substr(0, digits));
}

/// A field as JSON. `field`: "TYPE NAME", where TYPE may have "<=N" for strings and "[]", "[N]" or
/// "[<=N]". Sets `nested` to the type if it is a message.
std::string field_json(std::string_view field, std::string& nested) {
  const std::size_t space = std::min(field.find(' '), field.size());
  const std::string_view type = field.substr(0, space);
  const std::size_t bracket = std::min(type.find('['), type.size());
  const std::string_view element = type.substr(0, bracket), range = type.substr(bracket);
  const std::string_view base = element.substr(0, element.find('<'));
  const std::string string_capacity = number_after(element, "<=");
  const std::string at_most = number_after(range, "[<="), exactly = number_after(range, "[");
  const auto built_in = built_in_types.find(base);
  const bool is_built_in = built_in != built_in_types.end();
  if (!is_built_in) nested = base;
  int number = is_built_in ? built_in->second : nested_type;
  if (string_capacity != "0") number += bounded_string;
  if (at_most != "0")
    number += bounded_sequence;
  else if (exactly != "0")
    number += array;
  else if (!range.empty())
    number += unbounded_sequence;
  return R"({"name": ")" + std::string(field.substr(std::min(space + 1, field.size()))) +
         R"(", "type": {"type_id": )" + std::to_string(number) + R"(, "capacity": )" +
         (at_most != "0" ? at_most : exactly) + R"(, "string_capacity": )" + string_capacity +
         R"(, "nested_type_name": ")" + full_name(nested) + R"("}})";
}

std::string sha256_hex(const std::string& text) {
  sha256_ctx state;
  sha256_init(&state);
  sha256_update(&state, text.size(), reinterpret_cast<const std::uint8_t*>(text.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
  sha256_digest(&state, digest.size(), digest.data());
  std::string hex(BASE16_ENCODE_LENGTH(digest.size()), '\0');
  base16_encode_update(hex.data(), digest.size(), digest.data());
  return hex;
}

}  // namespace

std::string type_hash(std::string_view type, std::string_view definition) {
  const MessageDefinition messages(type, definition);
  std::map<std::string_view, const MessageFields*> known;
  for (const MessageFields& message : messages.types()) known.emplace(message.type, &message);
  std::map<std::string, std::string> descriptions;  // by full name, which is their order
  std::vector<std::string> pending = {short_type(type)};
  while (!pending.empty()) {
    const std::string name = std::move(pending.back());
    pending.pop_back();
    if (descriptions.contains(full_name(name))) continue;
    const auto message = known.find(name);
    if (message == known.end()) return {};
    std::string fields;
    for (const std::string& field : message->second->fields) {
      std::string nested;
      fields += (fields.empty() ? "" : ", ") + field_json(field, nested);
      if (!nested.empty()) pending.push_back(nested);
    }
    std::string none;
    if (fields.empty()) fields = field_json("uint8 structure_needs_at_least_one_member", none);
    descriptions[full_name(name)] =
        R"({"type_name": ")" + full_name(name) + R"(", "fields": [)" + fields + "]}";
  }
  const auto own = descriptions.extract(full_name(short_type(type)));
  std::string others;
  for (const auto& [name, description] : descriptions)
    others += (others.empty() ? "" : ", ") + description;
  return "RIHS01_" + sha256_hex(R"({"type_description": )" + own.mapped() +
                                R"(, "referenced_type_descriptions": [)" + others + "]}");
}

}  // namespace penumbra::io
