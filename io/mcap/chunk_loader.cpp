// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include <io/mcap/byte_cursor.hpp>
#include <io/mcap/chunk_loader.hpp>
#include <io/mcap/crc32.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::uint64_t latest_time = std::numeric_limits<std::int64_t>::max();

constexpr std::size_t spare_compressed = std::size_t{64} << 20;  // kept from chunk to chunk

bool is_later_version(Opcode opcode) { return opcode > Opcode::data_end; }

// Returns what is wrong with a message, or an empty text.
std::string take_message(std::span<const std::byte> content, std::uint64_t at,
                         std::vector<LoadedChunk::Entry>& messages) {
  const auto message = parse_message_head(content);
  if (!message) return "a message is shorter than its head; left out";
  if (std::max(message->log_time, message->publish_time) > latest_time)
    return "messages with times after the year 2262 are left out";
  messages.push_back({message->log_time, at, content.size()});
  return {};
}

// Reads a chunk's records up to the first damaged one.
void take_records(const MessagePlace& place, LoadedChunk& chunk, Definitions& definitions,
                  FaultLog& faults) {
  const auto records = std::span<const std::byte>(chunk.records);
  ByteCursor cursor(records);
  while (!cursor.rest().empty()) {
    const std::size_t at = records.size() - cursor.rest().size();
    const RecordHead head = parse_head(cursor.bytes(record_head_bytes));
    const auto content = cursor.bytes(head.length);
    if (!cursor.ok() || head.opcode == Opcode{0}) {
      faults.add(place.offset, "a chunk's records are damaged at byte " + std::to_string(at) +
                                   " of " + std::to_string(records.size()) +
                                   "; those from there on are left out");
      return;
    }
    if (head.opcode == Opcode::message) {
      const std::string fault = take_message(content, at + record_head_bytes, chunk.messages);
      if (!fault.empty()) faults.add(place.offset, fault);
    } else if (head.opcode == Opcode::schema || head.opcode == Opcode::channel) {
      definitions.add(head.opcode, content, place.offset, faults);
    } else if (!is_later_version(head.opcode)) {
      faults.add(place.offset, "a chunk holds records that no chunk may hold; left out");
    }
  }
}

}  // namespace

void ChunkLoader::load(const MessagePlace& place, LoadedChunk& chunk, Definitions& definitions,
                       FaultLog& faults) {
  chunk.records.clear();
  chunk.messages.clear();
  const std::string fault = load_records(place, chunk.records);
  if (compressed_.capacity() > spare_compressed) compressed_ = {};
  if (!fault.empty()) {
    chunk.records.clear();
    faults.add(place.offset, fault + "; its messages are left out");
    return;
  }
  take_records(place, chunk, definitions, faults);
  const auto earlier = [](const LoadedChunk::Entry& a, const LoadedChunk::Entry& b) {
    return a.log_time < b.log_time;
  };
  if (!std::is_sorted(chunk.messages.begin(), chunk.messages.end(), earlier))
    std::stable_sort(chunk.messages.begin(), chunk.messages.end(), earlier);
}

std::string ChunkLoader::load_records(const MessagePlace& place, std::vector<std::byte>& records) {
  constexpr const char* cut = "a chunk cannot be read to its end (was the file cut meanwhile?)";
  if (place.length > max_record_bytes + record_head_bytes && !place.loose)
    return "a chunk claims " + std::to_string(place.length) + " bytes, more than any may have";
  if (place.loose) return read(place.offset, place.length, records) ? std::string() : cut;

  std::array<std::byte, record_head_bytes + most_chunk_head_bytes> start{};
  const std::size_t got =
      file_->read_at(place.offset, start.data(), std::min<std::size_t>(start.size(), place.length));
  if (got < record_head_bytes) return cut;
  const std::span<const std::byte> bytes(start.data(), got);
  const RecordHead head = parse_head(bytes);
  if (head.opcode != Opcode::chunk || head.length != place.length - record_head_bytes)
    return "there is no chunk of " + std::to_string(place.length) + " bytes as the index says";
  const auto chunk = parse_chunk_head(bytes.subspan(record_head_bytes));
  if (!chunk || chunk->records_size > head.length - chunk->records_offset)
    return "a chunk's head is damaged";

  const std::uint64_t records_at = place.offset + record_head_bytes + chunk->records_offset;
  if (chunk->compression.empty()) {
    if (chunk->uncompressed_size != chunk->records_size)
      return "an uncompressed chunk has two different sizes";
    if (!read(records_at, chunk->records_size, records)) return cut;
  } else {
    if (!read(records_at, chunk->records_size, compressed_)) return cut;
    const std::string fault = decompressor_.decompress(chunk->compression, compressed_,
                                                       chunk->uncompressed_size, records);
    if (!fault.empty()) return "a chunk " + fault;
  }
  if (chunk->uncompressed_crc != 0 && crc32(records) != chunk->uncompressed_crc)
    return "a chunk has a wrong checksum";
  return {};
}

bool ChunkLoader::read(std::uint64_t offset, std::uint64_t count,
                       std::vector<std::byte>& to) const {
  if (offset > file_->size() || count > file_->size() - offset) return false;
  const auto bytes = static_cast<std::size_t>(count);
  to.clear();
  to.resize(bytes);
  return file_->read_at(offset, to.data(), bytes) == bytes;
}

}  // namespace penumbra::io::mcap
