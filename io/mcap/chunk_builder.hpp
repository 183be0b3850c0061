// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <io/mcap/record_builder.hpp>

namespace penumbra::io::mcap {

/// A written chunk, for the index.
struct WrittenChunk {
  ChunkHead head;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;                              // of the chunk record
  std::map<std::uint16_t, std::uint64_t> index_offsets;  // offset of each channel's message index
  std::uint64_t index_length = 0;                        // of all message indexes
};

/// Collects the records of a chunk and the positions of its messages.
class ChunkBuilder {
 public:
  void add(const Schema& schema) { put_schema(records_, schema); }
  void add(const Channel& channel) { put_channel(records_, channel); }
  void add(const MessageHead& head, std::span<const std::byte> data);

  [[nodiscard]] bool empty() const { return records_.size() == 0; }
  [[nodiscard]] std::size_t size() const { return records_.size(); }
  [[nodiscard]] std::span<const std::byte> records() const { return records_.view(); }
  [[nodiscard]] std::uint64_t start_time() const { return start_time_; }  ///< 0 without messages
  [[nodiscard]] std::uint64_t end_time() const { return end_time_; }

  /// Appends the message indexes, which will be at `offset` in the file, and stores their positions
  /// in `chunk`.
  void put_message_indexes(RecordBuilder& to, std::uint64_t offset, WrittenChunk& chunk) const;

  void clear();

 private:
  using Entry = std::pair<std::uint64_t, std::uint64_t>;  // log time, offset in the records

  RecordBuilder records_;
  std::map<std::uint16_t, std::vector<Entry>> entries_;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
};

void put_chunk_index(RecordBuilder& to, const WrittenChunk& chunk);

}  // namespace penumbra::io::mcap
