// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <string>

#include <io/mcap/byte_cursor.hpp>
#include <io/mcap/data_walk.hpp>

namespace penumbra::io::mcap {
namespace {

// Records outside of chunks are read in ranges of about this size.
constexpr std::uint64_t stretch_bytes = std::uint64_t{4} << 20;

constexpr std::size_t search_block = std::size_t{256} << 10;

bool of_data(Opcode opcode) {
  switch (opcode) {
    case Opcode::schema:
    case Opcode::channel:
    case Opcode::message:
    case Opcode::chunk:
    case Opcode::message_index:
      return true;
    default:
      return false;
  }
}

// Returns whether this is the start of a chunk's content. The fields of a chunk's head must agree
// in so many ways that other bytes do not pass.
bool is_chunk_content(std::span<const std::byte> content, std::uint64_t length) {
  const auto chunk = parse_chunk_head(content);
  return chunk && chunk->start_time <= chunk->end_time &&
         (chunk->compression.empty() || chunk->compression == "lz4" ||
          chunk->compression == "zstd") &&
         chunk->records_size == length - chunk->records_offset;
}

}  // namespace

void DataWalk::run(std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t at = begin; at < end && !has_end_;) {
    const auto bytes = window_->view(at, record_head_bytes);
    std::string fault;
    RecordHead head;
    if (end - at < record_head_bytes || bytes.size() < record_head_bytes) {
      fault = "a record begins here and is cut (was the recorder killed?)";
    } else {
      head = parse_head(bytes);
      fault = fault_of(head, end - at - record_head_bytes);
    }
    if (fault.empty()) {
      take(head, at);
      at += record_head_bytes + head.length;
      continue;
    }
    const std::uint64_t next = find_chunk(at + 1, end);
    damaged_ = true;
    faults_->add(at, fault + "; " + std::to_string(next - at) + " bytes are left out");
    at = next;
  }
}

std::string DataWalk::fault_of(const RecordHead& head, std::uint64_t left) const {
  if (head.opcode == Opcode{0}) return "no record begins here";
  if (head.length > left)
    return "a record claims " + std::to_string(head.length) + " bytes where " +
           std::to_string(left) + " are left (was the recorder killed?)";
  if (of_data(head.opcode) && head.length > max_record_bytes)
    return "a record claims " + std::to_string(head.length) + " bytes, more than any may have";
  return {};
}

void DataWalk::take(const RecordHead& head, std::uint64_t offset) {
  switch (head.opcode) {
    case Opcode::schema:
    case Opcode::channel:
      return take_definition(head, offset);
    case Opcode::message:
      return take_message(head, offset);
    case Opcode::chunk:
      return take_chunk(head, offset);
    default:
      break;
  }
  if (const std::string fault = fault_of_skipped(head, offset); !fault.empty())
    return skip(head, offset, fault);
  if (head.opcode == Opcode::message_index) take_message_index(offset);
  has_end_ = head.opcode == Opcode::footer || head.opcode == Opcode::data_end;
}

// Returns what is wrong with a record that is not needed, or an empty text if it may be skipped.
// Without this check, a flipped bit in a record's kind could hide a chunk.
std::string DataWalk::fault_of_skipped(const RecordHead& head, std::uint64_t offset) {
  const std::string kind = "a record of kind " + std::to_string(static_cast<int>(head.opcode));
  const auto content = window_->view(
      offset + record_head_bytes,
      static_cast<std::size_t>(std::min<std::uint64_t>(head.length, most_chunk_head_bytes)));
  if (is_chunk_content(content, head.length)) return kind + " has the content of a chunk";
  switch (head.opcode) {
    case Opcode::message_index:
    case Opcode::attachment:
    case Opcode::metadata:
    case Opcode::data_end:
    case Opcode::footer:
      return {};
    default:
      return kind +
             (head.opcode > Opcode::data_end ? " is not known" : " does not belong among the data");
  }
}

void DataWalk::skip(const RecordHead& head, std::uint64_t offset, const std::string& fault) {
  if (head.opcode > Opcode::data_end && !reported_.insert(head.opcode).second) return;
  faults_->add(offset, fault + "; its " + std::to_string(head.length) + " bytes are skipped");
}

void DataWalk::take_definition(const RecordHead& head, std::uint64_t offset) {
  if (head.length > max_definition_bytes)
    return skip(head, offset, "a schema or channel is far too long");
  const auto content =
      window_->view(offset + record_head_bytes, static_cast<std::size_t>(head.length));
  layout_->definitions.add(head.opcode, content, offset, *faults_);
}

void DataWalk::take_message(const RecordHead& head, std::uint64_t offset) {
  const auto content = window_->view(
      offset + record_head_bytes,
      static_cast<std::size_t>(std::min<std::uint64_t>(head.length, message_head_bytes)));
  const auto message = parse_message_head(content);
  const std::uint64_t time = message ? message->log_time : 0;
  auto& places = layout_->places;
  const bool goes_on = !places.empty() && places.back().loose &&
                       places.back().offset + places.back().length == offset &&
                       places.back().length < stretch_bytes;
  if (!goes_on) {
    places.emplace_back();
    places.back().offset = offset;
    places.back().start_time = time;
    places.back().loose = places.back().channels_known = true;
  }
  MessagePlace& place = places.back();
  place.length += record_head_bytes + head.length;
  place.start_time = std::min(place.start_time, time);
}

void DataWalk::take_chunk(const RecordHead& head, std::uint64_t offset) {
  const auto content = window_->view(
      offset + record_head_bytes,
      static_cast<std::size_t>(std::min<std::uint64_t>(head.length, most_chunk_head_bytes)));
  const auto chunk = parse_chunk_head(content);
  if (!chunk) {
    faults_->add(offset, "a chunk's head is damaged; its messages are left out");
    return;
  }
  MessagePlace& place = layout_->places.emplace_back();
  place.offset = offset;
  place.length = record_head_bytes + head.length;
  place.start_time = chunk->start_time;
}

void DataWalk::take_message_index(std::uint64_t offset) {
  ByteCursor cursor(window_->view(offset + record_head_bytes, sizeof(std::uint16_t)));
  const auto channel = cursor.number<std::uint16_t>();
  if (layout_->places.empty() || layout_->places.back().loose || !cursor.ok()) return;
  layout_->places.back().channels.push_back(channel);
  layout_->places.back().channels_known = true;
}

// Returns whether a chunk begins here.
bool DataWalk::is_chunk(std::span<const std::byte> bytes, std::uint64_t left) const {
  if (bytes.size() < record_head_bytes || left < record_head_bytes) return false;
  const RecordHead head = parse_head(bytes);
  if (head.opcode != Opcode::chunk || !fault_of(head, left - record_head_bytes).empty())
    return false;
  return is_chunk_content(bytes.subspan(record_head_bytes), head.length);
}

std::uint64_t DataWalk::find_chunk(std::uint64_t from, std::uint64_t end) {
  constexpr int wanted = static_cast<int>(Opcode::chunk);
  constexpr std::size_t enough = record_head_bytes + most_chunk_head_bytes;
  for (std::uint64_t at = from; at < end;) {
    const auto bytes = window_->view(
        at, static_cast<std::size_t>(std::min<std::uint64_t>(search_block, end - at)));
    const bool last = bytes.size() < search_block;
    const std::size_t starts = last ? bytes.size() : bytes.size() - enough;
    for (std::size_t i = 0; i < starts; ++i) {
      const void* found = std::memchr(bytes.data() + i, wanted, starts - i);
      if (found == nullptr) break;
      i = static_cast<std::size_t>(static_cast<const std::byte*>(found) - bytes.data());
      if (is_chunk(bytes.subspan(i), end - at - i)) return at + i;
    }
    if (last) break;
    at += starts;
  }
  return end;
}

}  // namespace penumbra::io::mcap
