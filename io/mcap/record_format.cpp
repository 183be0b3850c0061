// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <io/mcap/byte_cursor.hpp>
#include <io/mcap/record_format.hpp>

namespace penumbra::io::mcap {
namespace {

template <typename T>
std::optional<T> if_whole(const ByteCursor& cursor, T& value) {
  if (!cursor.ok()) return std::nullopt;
  return std::move(value);
}

}  // namespace

RecordHead parse_head(std::span<const std::byte> bytes) {
  ByteCursor cursor(bytes);
  const auto opcode = Opcode{cursor.number<std::uint8_t>()};
  return {opcode, cursor.number<std::uint64_t>()};
}

std::optional<HeaderRecord> parse_header(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  HeaderRecord header;
  header.profile = cursor.text();
  header.library = cursor.text();
  return if_whole(cursor, header);
}

std::optional<FooterRecord> parse_footer(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  FooterRecord footer;
  footer.summary_start = cursor.number<std::uint64_t>();
  footer.summary_offset_start = cursor.number<std::uint64_t>();
  footer.summary_crc = cursor.number<std::uint32_t>();
  return if_whole(cursor, footer);
}

std::optional<Schema> parse_schema(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  Schema schema;
  schema.id = cursor.number<std::uint16_t>();
  schema.name = cursor.text();
  schema.encoding = cursor.text();
  schema.data = cursor.text();
  return if_whole(cursor, schema);
}

std::optional<Channel> parse_channel(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  Channel channel;
  channel.id = cursor.number<std::uint16_t>();
  channel.schema_id = cursor.number<std::uint16_t>();
  channel.topic = cursor.text();
  channel.message_encoding = cursor.text();
  ByteCursor pairs(cursor.counted());
  while (pairs.ok() && !pairs.rest().empty()) {
    std::string key = pairs.text();
    channel.metadata.insert_or_assign(std::move(key), pairs.text());
  }
  if (!pairs.ok()) return std::nullopt;
  return if_whole(cursor, channel);
}

std::optional<Statistics> parse_statistics(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  Statistics statistics;
  statistics.messages = cursor.number<std::uint64_t>();
  statistics.schemas = cursor.number<std::uint16_t>();
  statistics.channels = cursor.number<std::uint32_t>();
  statistics.attachments = cursor.number<std::uint32_t>();
  statistics.metadata = cursor.number<std::uint32_t>();
  statistics.chunks = cursor.number<std::uint32_t>();
  statistics.start_time = cursor.number<std::uint64_t>();
  statistics.end_time = cursor.number<std::uint64_t>();
  ByteCursor counts(cursor.counted());
  while (counts.ok() && !counts.rest().empty()) {
    const auto channel = counts.number<std::uint16_t>();
    statistics.channel_messages.insert_or_assign(channel, counts.number<std::uint64_t>());
  }
  if (!counts.ok()) return std::nullopt;
  return if_whole(cursor, statistics);
}

std::optional<ChunkIndexRecord> parse_chunk_index(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  ChunkIndexRecord index;
  index.start_time = cursor.number<std::uint64_t>();
  index.end_time = cursor.number<std::uint64_t>();
  index.offset = cursor.number<std::uint64_t>();
  index.length = cursor.number<std::uint64_t>();
  ByteCursor offsets(cursor.counted());
  while (offsets.ok() && !offsets.rest().empty()) {
    index.channels.push_back(offsets.number<std::uint16_t>());
    offsets.number<std::uint64_t>();  // offset of the message index; the chunk itself is read
  }
  index.message_index_length = cursor.number<std::uint64_t>();
  cursor.counted();                         // compression, as in the chunk
  cursor.bytes(2 * sizeof(std::uint64_t));  // sizes, as in the chunk
  if (!offsets.ok()) return std::nullopt;
  return if_whole(cursor, index);
}

std::optional<MessageHead> parse_message_head(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  MessageHead head;
  head.channel = cursor.number<std::uint16_t>();
  head.sequence = cursor.number<std::uint32_t>();
  head.log_time = cursor.number<std::uint64_t>();
  head.publish_time = cursor.number<std::uint64_t>();
  return if_whole(cursor, head);
}

std::optional<ChunkHead> parse_chunk_head(std::span<const std::byte> content) {
  ByteCursor cursor(content);
  ChunkHead head;
  head.start_time = cursor.number<std::uint64_t>();
  head.end_time = cursor.number<std::uint64_t>();
  head.uncompressed_size = cursor.number<std::uint64_t>();
  head.uncompressed_crc = cursor.number<std::uint32_t>();
  head.compression = cursor.text();
  head.records_size = cursor.number<std::uint64_t>();
  head.records_offset = content.size() - cursor.rest().size();
  return if_whole(cursor, head);
}

}  // namespace penumbra::io::mcap
