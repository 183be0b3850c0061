// SPDX-License-Identifier: Apache-2.0
#include <io/mcap/record_builder.hpp>

namespace penumbra::io::mcap {

void put_schema(RecordBuilder& to, const Schema& schema) {
  to.begin(Opcode::schema);
  to.number(schema.id);
  to.text(schema.name);
  to.text(schema.encoding);
  to.text(schema.data);
  to.end();
}

void put_channel(RecordBuilder& to, const Channel& channel) {
  to.begin(Opcode::channel);
  to.number(channel.id);
  to.number(channel.schema_id);
  to.text(channel.topic);
  to.text(channel.message_encoding);
  const std::size_t pairs = to.begin_counted<std::uint32_t>();
  for (const auto& [key, value] : channel.metadata) {
    to.text(key);
    to.text(value);
  }
  to.end_counted<std::uint32_t>(pairs);
  to.end();
}

void put_statistics(RecordBuilder& to, const Statistics& statistics) {
  to.begin(Opcode::statistics);
  to.number(statistics.messages);
  to.number(statistics.schemas);
  to.number(statistics.channels);
  to.number(statistics.attachments);
  to.number(statistics.metadata);
  to.number(statistics.chunks);
  to.number(statistics.start_time);
  to.number(statistics.end_time);
  const std::size_t counts = to.begin_counted<std::uint32_t>();
  for (const auto& [channel, count] : statistics.channel_messages) {
    to.number(channel);
    to.number(count);
  }
  to.end_counted<std::uint32_t>(counts);
  to.end();
}

void put_chunk_head(RecordBuilder& to, const ChunkHead& head) {
  // The length is computed first, because the records follow the head and are elsewhere in memory.
  const std::uint64_t own = 3 * sizeof(std::uint64_t) + 2 * sizeof(std::uint32_t) +
                            head.compression.size() + sizeof(std::uint64_t);
  to.number(static_cast<std::uint8_t>(Opcode::chunk));
  to.number(own + head.records_size);
  to.number(head.start_time);
  to.number(head.end_time);
  to.number(head.uncompressed_size);
  to.number(head.uncompressed_crc);
  to.text(head.compression);
  to.number(head.records_size);
}

}  // namespace penumbra::io::mcap
