// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include <io/mcap/compression.hpp>
#include <io/mcap/file_index.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::size_t most_faults = 1000;

// The limit for all schemas and channels of a file; those of ROS 2 have a few kilobytes each. It
// also limits every other record in memory, except messages and chunks.
constexpr std::uint64_t most_definition_bytes = std::uint64_t{64} << 20;

constexpr std::size_t block_bytes = std::size_t{64} << 10;           // that are read at a time
constexpr std::uint64_t range_bytes = std::uint64_t{4} << 20;        // of records outside of chunks
constexpr std::uint64_t most_search_bytes = std::uint64_t{2} << 30;  // without a chunk
constexpr std::uint64_t least_chunk_bytes = record_head_bytes + 40;
constexpr std::uint64_t footer_bytes = 20;
constexpr std::uint64_t end_bytes = record_head_bytes + footer_bytes + magic_bytes.size();

// A part of a file in memory that moves with the accesses. Files are read, not mapped, so that a
// file that is truncated meanwhile ends the reading and not the program.
class FileWindow {
 public:
  explicit FileWindow(const InputFile& file) : file_(file) {}

  [[nodiscard]] std::uint64_t file_size() const { return file_.size(); }

  // Returns `count` bytes from `offset`, fewer at the end of the file; valid until the next call.
  std::span<const std::byte> view(std::uint64_t offset, std::uint64_t count) {
    if (offset >= file_size()) return {};
    const std::uint64_t left = file_size() - offset;
    count = std::min(count, left);
    if (offset < start_ || offset + count > start_ + bytes_.size()) {
      bytes_.resize(std::min(std::max<std::uint64_t>(count, block_bytes), left));
      bytes_.resize(file_.read_at(offset, bytes_.data(), bytes_.size()));
      start_ = offset;
    }
    const std::span<const std::byte> bytes(bytes_);
    return bytes.subspan(offset - start_, std::min(count, start_ + bytes.size() - offset));
  }

  // Returns the head of the record at `offset` if it ends before `end`.
  std::optional<RecordHead> head(std::uint64_t offset, std::uint64_t end) {
    const auto bytes = view(offset, record_head_bytes);
    if (end - offset < record_head_bytes || bytes.size() < record_head_bytes) return std::nullopt;
    return RecordParser(bytes).head();
  }

 private:
  const InputFile& file_;
  std::uint64_t start_ = 0;
  std::vector<std::byte> bytes_;
};

// Returns whether this is the start of a chunk's content. The fields of a chunk's head must agree
// in so many ways that other bytes do not pass.
bool is_chunk_content(std::span<const std::byte> content, std::uint64_t length) {
  const auto chunk = parse<ChunkHead>(content);
  return chunk && chunk->start_time <= chunk->end_time &&
         (chunk->compression.empty() || chunk->compression == "lz4" ||
          chunk->compression == "zstd") &&
         chunk->records_size == length - chunk->records_offset();
}

// Returns what is wrong with a record in the data section, or an empty text. `left`: bytes after
// its head.
std::string fault_of(const RecordHead& head, std::uint64_t left) {
  if (head.opcode == Opcode{0}) return "no record begins here";
  if (head.length > left)
    return "a record claims " + std::to_string(head.length) + " bytes where " +
           std::to_string(left) + " are left (was the recorder killed?)";
  const bool is_limited = head.opcode >= Opcode::schema && head.opcode <= Opcode::message_index;
  if (is_limited && head.length > max_record_bytes)
    return "a record claims " + std::to_string(head.length) + " bytes, more than any may have";
  return {};
}

// Returns whether the chunks of an index lie one after another between two offsets.
bool lie_in_order(std::vector<ChunkIndex>& chunks, std::uint64_t begin, std::uint64_t end) {
  std::sort(chunks.begin(), chunks.end(),
            [](const auto& a, const auto& b) { return a.offset < b.offset; });
  for (const ChunkIndex& chunk : chunks) {
    if (chunk.offset < begin || chunk.offset > end || chunk.length < least_chunk_bytes ||
        chunk.length > end - chunk.offset || chunk.index_length > end - chunk.offset - chunk.length)
      return false;
    begin = chunk.offset + chunk.length + chunk.index_length;
  }
  return true;
}

// Adds a definition. Returns whether it is new and consistent.
template <typename T>
bool keep(std::map<std::uint16_t, T>& all, std::optional<T> found, const std::string& kind,
          std::uint64_t offset, FaultLog& faults) {
  if (!found) {
    faults.add(offset, "a " + kind + "'s record is damaged; left out");
    return false;
  }
  const auto [known, is_new] = all.try_emplace(found->id, *found);
  if (!is_new && known->second != *found)
    faults.add(offset, kind + " " + std::to_string(found->id) +
                           " has another definition earlier in the file; the first one holds");
  return is_new;
}

class IndexReader {
 public:
  IndexReader(const InputFile& file, FaultLog& faults) : window_(file), faults_(faults) {}

  FileIndex read() {
    const std::uint64_t begin = read_header();
    const auto footer = read_footer();
    const bool has_summary = footer && footer->summary_start != 0 && read_summary(*footer, begin);
    std::uint64_t at = begin;
    // Messages that are not in the index lie between the indexed chunks.
    for (const ChunkIndex& chunk : chunks_) {
      walk(at, chunk.offset);
      MessagePlace& place = add_place(chunk.offset, chunk.length, chunk.start_time);
      if (!chunk.index_offsets.empty()) place.channels.emplace();
      for (const auto& [channel, offset] : chunk.index_offsets) place.channels->push_back(channel);
      at = chunk.offset + chunk.length + chunk.index_length;
    }
    walk(at, has_summary ? footer->summary_start : window_.file_size());

    if (!has_end_ && !is_damaged_ && !has_summary)
      faults_.add(window_.file_size(),
                  "the data has no end (was the recorder killed?); all of it is read");
    if (has_end_ && !footer)
      faults_.add(window_.file_size(),
                  "the file has no footer (was it cut?); it is read without its summary");
    return std::move(index_);
  }

 private:
  std::span<const std::byte> content(const RecordHead& head, std::uint64_t offset,
                                     std::uint64_t most = most_definition_bytes) {
    return window_.view(offset + record_head_bytes, std::min(head.length, most));
  }

  MessagePlace& add_place(std::uint64_t offset, std::uint64_t length, std::uint64_t start_time) {
    MessagePlace& place = index_.places.emplace_back();
    place.offset = offset;
    place.length = length;
    place.start_time = start_time;
    return place;
  }

  // Returns the offset after the header.
  std::uint64_t read_header() {
    const std::uint64_t at = magic_bytes.size();
    const auto head = window_.head(at, window_.file_size());
    const std::uint64_t end = head ? at + record_head_bytes + head->length : 0;
    if (!head || head->opcode != Opcode::header || head->length > most_definition_bytes ||
        end > window_.file_size()) {
      faults_.add(at, "the file has no header; profile and library are not known");
      return at;
    }
    auto header = parse<Header>(content(*head, at));
    if (!header) faults_.add(at, "the file's header is damaged; profile and library are not known");
    index_.header = std::move(header).value_or(Header());
    return end;
  }

  // Returns the last record of a complete file, or nothing if the file is truncated.
  std::optional<Footer> read_footer() {
    const std::uint64_t size = window_.file_size();
    if (size < magic_bytes.size() + end_bytes) return std::nullopt;
    const auto bytes = window_.view(size - end_bytes, end_bytes);
    if (bytes.size() < end_bytes) return std::nullopt;
    const RecordHead head = RecordParser(bytes).head();
    const auto magic = bytes.last(magic_bytes.size());
    if (head.opcode != Opcode::footer || head.length != footer_bytes ||
        !std::equal(magic.begin(), magic.end(), magic_bytes.begin()))
      return std::nullopt;
    return parse<Footer>(bytes.subspan(record_head_bytes, footer_bytes));
  }

  // Reads the summary, which makes it unnecessary to read the whole file. Returns whether it can be
  // used.
  bool read_summary(const Footer& footer, std::uint64_t begin) {
    const std::uint64_t end = window_.file_size() - end_bytes;
    const auto refuse = [&](const std::string& what) {
      faults_.add(end, "the summary " + what + "; the file is read without it");
      chunks_.clear();
      return false;
    };
    if (footer.summary_start < begin || footer.summary_start > end)
      return refuse("should begin at " + std::to_string(footer.summary_start) +
                    ", which lies outside of the file");
    if (footer.summary_crc != 0 && checksum(footer.summary_start) != footer.summary_crc)
      return refuse("has a wrong checksum");
    FileIndex summary;
    if (!take_summary(footer.summary_start, end, summary)) return refuse("is damaged");
    if (!lie_in_order(chunks_, begin, footer.summary_start))
      return refuse("has an index of chunks that overlap or lie outside of the data");
    summary.header = std::move(index_.header);
    summary.summary_has_channels = !summary.channels.empty();
    index_ = std::move(summary);
    return true;
  }

  // Returns the CRC from an offset up to the footer's own CRC.
  std::uint32_t checksum(std::uint64_t at) {
    const std::uint64_t end = window_.file_size() - magic_bytes.size() - sizeof(std::uint32_t);
    std::uint32_t crc = 0;
    while (at < end) {
      const auto bytes = window_.view(at, std::min<std::uint64_t>(block_bytes, end - at));
      if (bytes.empty()) return 0;
      crc = crc32(bytes, crc);
      at += bytes.size();
    }
    return crc;
  }

  bool take_summary(std::uint64_t at, std::uint64_t end, FileIndex& summary) {
    while (at < end) {
      const auto head = window_.head(at, end);
      if (!head || head->length > end - at - record_head_bytes) return false;
      if (!take_summary_record(*head, at, summary)) return false;
      at += record_head_bytes + head->length;
    }
    return true;
  }

  bool take_summary_record(const RecordHead& head, std::uint64_t at, FileIndex& summary) {
    const bool is_definition = head.opcode == Opcode::schema || head.opcode == Opcode::channel;
    if (!is_definition && head.opcode != Opcode::statistics && head.opcode != Opcode::chunk_index)
      return true;  // attachments and metadata are not read
    const auto bytes = content(head, at);
    if (bytes.size() < head.length) return false;
    if (is_definition) {
      summary.define(head.opcode, bytes, at, faults_);
      return true;
    }
    if (head.opcode == Opcode::statistics)
      return (summary.statistics = parse<Statistics>(bytes)).has_value();
    auto chunk = parse<ChunkIndex>(bytes);
    if (chunk) chunks_.push_back(std::move(*chunk));
    return chunk.has_value();
  }

  // Adds the records between two offsets to the index without reading the messages, and stops at
  // the end of the data section. After damage it continues at the next recognisable chunk.
  void walk(std::uint64_t at, std::uint64_t end) {
    while (at < end && !has_end_) {
      const auto head = window_.head(at, end);
      const std::string fault = head ? fault_of(*head, end - at - record_head_bytes)
                                     : "a record begins here and is cut (was the recorder killed?)";
      if (fault.empty()) {
        take(*head, at);
        at += record_head_bytes + head->length;
        continue;
      }
      const std::uint64_t next = find_chunk(at + 1, end);
      is_damaged_ = true;
      faults_.add(at, fault + "; " + std::to_string(next - at) + " bytes are left out");
      at = next;
    }
  }

  void take(const RecordHead& head, std::uint64_t at) {
    switch (head.opcode) {
      case Opcode::schema:
      case Opcode::channel:
        if (head.length > most_definition_bytes)
          return skip(head, at, "a schema or channel is far too long");
        return index_.define(head.opcode, content(head, at), at, faults_);
      case Opcode::message:
        return take_message(head, at);
      case Opcode::chunk:
        return take_chunk(head, at);
      default:
        return take_other(head, at);
    }
  }

  void take_message(const RecordHead& head, std::uint64_t at) {
    const auto message = parse<MessageHead>(content(head, at, message_head_bytes));
    const std::uint64_t time = message ? message->log_time : 0;
    auto& places = index_.places;
    const bool goes_on = !places.empty() && places.back().loose &&
                         places.back().offset + places.back().length == at &&
                         places.back().length < range_bytes;
    if (!goes_on) {
      add_place(at, 0, time).loose = true;
      places.back().channels.emplace();
    }
    places.back().length += record_head_bytes + head.length;
    places.back().start_time = std::min(places.back().start_time, time);
  }

  void take_chunk(const RecordHead& head, std::uint64_t at) {
    if (const auto chunk = parse<ChunkHead>(content(head, at, ChunkHead::most_bytes)))
      add_place(at, record_head_bytes + head.length, chunk->start_time);
    else
      faults_.add(at, "a chunk's head is damaged; its messages are left out");
  }

  // Takes a record that holds no messages. Without the first check, a flipped bit in a record's
  // kind could hide a chunk.
  void take_other(const RecordHead& head, std::uint64_t at) {
    const std::string kind = "a record of kind " + std::to_string(static_cast<int>(head.opcode));
    if (is_chunk_content(content(head, at, ChunkHead::most_bytes), head.length))
      return skip(head, at, kind + " has the content of a chunk");
    switch (head.opcode) {
      case Opcode::message_index:
        return take_message_index(head, at);
      case Opcode::attachment:
      case Opcode::metadata:
        return;
      case Opcode::data_end:
      case Opcode::footer:
        has_end_ = true;
        return;
      default:
        if (head.opcode <= Opcode::data_end)
          skip(head, at, kind + " does not belong among the data");
        else if (unknown_.insert(head.opcode).second)
          skip(head, at, kind + " is not known");
    }
  }

  void skip(const RecordHead& head, std::uint64_t at, const std::string& fault) {
    faults_.add(at, fault + "; its " + std::to_string(head.length) + " bytes are skipped");
  }

  void take_message_index(const RecordHead& head, std::uint64_t at) {
    RecordParser parser(content(head, at, 6));
    std::uint16_t channel = 0;
    std::uint32_t bytes = 0;
    parser(channel, bytes);
    const std::uint64_t needed = std::uint64_t{6} + bytes;
    // The format allows more bytes, but so many could hide the chunk that follows.
    if (!parser.ok() || head.length < needed || head.length - needed >= least_chunk_bytes)
      return skip(head, at, "a message index is damaged");
    if (index_.places.empty() || index_.places.back().loose) return;
    auto& channels = index_.places.back().channels;
    if (!channels) channels.emplace();
    channels->push_back(channel);
  }

  // Returns the offset of the next chunk, or `end` if there is none within most_search_bytes.
  std::uint64_t find_chunk(std::uint64_t at, std::uint64_t end) {
    const std::uint64_t limit = std::min(end, at + most_search_bytes);
    constexpr std::size_t enough = record_head_bytes + ChunkHead::most_bytes;
    while (at < limit) {
      const auto bytes = window_.view(at, std::min<std::uint64_t>(block_bytes, end - at));
      const bool last = bytes.size() < block_bytes;
      const std::size_t starts = last ? bytes.size() : bytes.size() - enough;
      for (std::size_t i = 0; i < starts; ++i) {
        const void* found =
            std::memchr(bytes.data() + i, static_cast<int>(Opcode::chunk), starts - i);
        if (found == nullptr) break;
        i = static_cast<std::size_t>(static_cast<const std::byte*>(found) - bytes.data());
        const std::uint64_t left = end - at - i;
        if (left < record_head_bytes || bytes.size() - i < record_head_bytes) break;
        const RecordHead head = RecordParser(bytes.subspan(i)).head();
        if (fault_of(head, left - record_head_bytes).empty() &&
            is_chunk_content(bytes.subspan(i + record_head_bytes), head.length))
          return at + i;
      }
      if (last) break;
      at += starts;
    }
    return end;
  }

  FileWindow window_;
  FaultLog& faults_;
  FileIndex index_;
  std::vector<ChunkIndex> chunks_;  // of the summary
  bool has_end_ = false;            // the end of the data section was reached
  bool is_damaged_ = false;
  std::set<Opcode> unknown_;  // kinds of records that were reported
};

}  // namespace

void FaultLog::add(std::uint64_t offset, const std::string& what) {
  if (faults_.size() > most_faults) return;
  const auto same = [&](const Fault& f) { return f.offset == offset && f.what == what; };
  if (std::any_of(faults_.begin(), faults_.end(), same)) return;
  const bool is_full = faults_.size() == most_faults;
  faults_.push_back({offset, is_full ? "from here on: more faults, which are not listed" : what});
}

void FileIndex::define(Opcode opcode, std::span<const std::byte> content, std::uint64_t offset,
                       FaultLog& faults) {
  if (definition_bytes_ + content.size() > most_definition_bytes)
    return faults.add(offset, "schemas and channels have more than " +
                                  std::to_string(most_definition_bytes) +
                                  " bytes; the rest is left out");
  bool is_new = false;
  if (opcode == Opcode::channel) {
    is_new = keep(channels, parse<Channel>(content), "channel", offset, faults);
  } else {
    auto schema = parse<Schema>(content);
    if (schema && schema->id == 0)
      return faults.add(offset, "a schema has the id 0, which means no schema; left out");
    is_new = keep(schemas, std::move(schema), "schema", offset, faults);
  }
  if (is_new) definition_bytes_ += content.size();
}

bool FileIndex::may_define(const MessagePlace& place) const {
  const auto lacks = [&](std::uint16_t channel) { return !is_complete(channel); };
  if (place.channels) return std::any_of(place.channels->begin(), place.channels->end(), lacks);
  return !summary_has_channels ||
         std::any_of(channels.begin(), channels.end(),
                     [&](const auto& channel) { return lacks(channel.first); });
}

bool FileIndex::is_complete(std::uint16_t channel) const {
  const auto known = channels.find(channel);
  return known != channels.end() &&
         (known->second.schema_id == 0 || schemas.contains(known->second.schema_id));
}

FileIndex read_index(const InputFile& file, FaultLog& faults) {
  return IndexReader(file, faults).read();
}

}  // namespace penumbra::io::mcap
