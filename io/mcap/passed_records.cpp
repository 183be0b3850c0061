// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/mcap/byte_cursor.hpp>
#include <io/mcap/passed_records.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::uint64_t most_looked_at = std::uint64_t{64} << 10;
constexpr std::uint64_t index_entry_bytes = 16;
constexpr std::uint64_t most_later_bytes = 64;  // for fields that later versions may add

// Reads a text. Returns whether it is valid.
bool take_name(ByteCursor& cursor) {
  const auto name = cursor.counted();
  return cursor.ok() && std::find(name.begin(), name.end(), std::byte{0}) == name.end();
}

// Returns whether a record's fields fill the record, except for a few later fields.
bool fill(std::uint64_t fields, std::uint64_t length) {
  return fields <= length && length - fields <= most_later_bytes;
}

bool is_message_index(ByteCursor cursor, std::uint64_t length) {
  const std::uint64_t head = sizeof(std::uint16_t) + sizeof(std::uint32_t);
  cursor.number<std::uint16_t>();  // channel
  const auto entries = cursor.number<std::uint32_t>();
  return cursor.ok() && entries % index_entry_bytes == 0 && fill(head + entries, length);
}

bool is_attachment(ByteCursor cursor, std::uint64_t length) {
  const std::size_t whole = cursor.rest().size();
  cursor.bytes(2 * sizeof(std::uint64_t));  // times
  bool named = take_name(cursor);
  named = take_name(cursor) && named;  // media type
  const auto data = cursor.number<std::uint64_t>();
  const std::uint64_t head = whole - cursor.rest().size();
  constexpr std::uint64_t crc = sizeof(std::uint32_t);
  return named && cursor.ok() && data <= length && fill(head + data + crc, length);
}

bool is_metadata(ByteCursor cursor, std::uint64_t length) {
  const std::size_t whole = cursor.rest().size();
  const bool named = take_name(cursor);
  const auto pairs = cursor.number<std::uint32_t>();
  return named && cursor.ok() && fill(whole - cursor.rest().size() + pairs, length);
}

}  // namespace

std::string fault_of_passed(const RecordHead& head, std::uint64_t offset, FileWindow& window) {
  const std::uint64_t content_at = offset + record_head_bytes;
  const ByteCursor content(window.view(
      content_at, static_cast<std::size_t>(std::min<std::uint64_t>(head.length, most_looked_at))));
  switch (head.opcode) {
    case Opcode::message_index:
      return is_message_index(content, head.length) ? "" : "a message index is damaged";
    case Opcode::attachment:
      return is_attachment(content, head.length) ? "" : "an attachment is damaged";
    case Opcode::metadata:
      return is_metadata(content, head.length) ? "" : "a record of metadata is damaged";
    case Opcode::data_end:
      return head.length >= sizeof(std::uint32_t) &&
                     head.length <= sizeof(std::uint32_t) + most_later_bytes
                 ? ""
                 : "the data's end is damaged";
    case Opcode::footer:
      return content_at + head.length + magic_bytes.size() == window.file_size()
                 ? ""
                 : "a footer is not at the end of the file";
    default:
      return head.opcode > Opcode::data_end
                 ? "a record of kind " + std::to_string(static_cast<int>(head.opcode)) +
                       " is not known"
                 : "a record of kind " + std::to_string(static_cast<int>(head.opcode)) +
                       " does not belong among the data";
  }
}

}  // namespace penumbra::io::mcap
