// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <io/mcap/chunk_builder.hpp>

namespace penumbra::io::mcap {

void ChunkBuilder::add(const MessageHead& head, std::span<const std::byte> data) {
  start_time_ = entries_.empty() ? head.log_time : std::min(start_time_, head.log_time);
  end_time_ = std::max(end_time_, head.log_time);
  entries_[head.channel].emplace_back(head.log_time, records_.size());
  records_.begin(Opcode::message);
  records_.number(head.channel);
  records_.number(head.sequence);
  records_.number(head.log_time);
  records_.number(head.publish_time);
  records_.bytes(data);
  records_.end();
}

void ChunkBuilder::put_message_indexes(RecordBuilder& to, std::uint64_t offset,
                                       WrittenChunk& chunk) const {
  const std::size_t start = to.size();
  for (const auto& [channel, entries] : entries_) {
    chunk.index_offsets.emplace(channel, offset + to.size() - start);
    to.begin(Opcode::message_index);
    to.number(channel);
    const std::size_t list = to.begin_counted<std::uint32_t>();
    for (const auto& [time, at] : entries) {
      to.number(time);
      to.number(at);
    }
    to.end_counted<std::uint32_t>(list);
    to.end();
  }
  chunk.index_length = to.size() - start;
}

void ChunkBuilder::clear() {
  records_.clear();
  entries_.clear();
  start_time_ = end_time_ = 0;
}

void put_chunk_index(RecordBuilder& to, const WrittenChunk& chunk) {
  to.begin(Opcode::chunk_index);
  to.number(chunk.head.start_time);
  to.number(chunk.head.end_time);
  to.number(chunk.offset);
  to.number(chunk.length);
  const std::size_t offsets = to.begin_counted<std::uint32_t>();
  for (const auto& [channel, offset] : chunk.index_offsets) {
    to.number(channel);
    to.number(offset);
  }
  to.end_counted<std::uint32_t>(offsets);
  to.number(chunk.index_length);
  to.text(chunk.head.compression);
  to.number(chunk.head.records_size);
  to.number(chunk.head.uncompressed_size);
  to.end();
}

}  // namespace penumbra::io::mcap
