// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

#include <penumbra/base/version.hpp>

#include <io/files/disk_file.hpp>
#include <io/mcap/crc32.hpp>
#include <io/mcap/record_builder.hpp>
#include <io/mcap/writer.hpp>

namespace penumbra::io::mcap {

constexpr std::size_t most_chunk_size = max_record_bytes / 2;

// A written chunk, for the index.
struct WrittenChunk {
  ChunkHead head;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;                              // of the chunk record
  std::map<std::uint16_t, std::uint64_t> index_offsets;  // offset of each channel's message index
  std::uint64_t index_length = 0;                        // of all message indexes
};

// Collects the records of a chunk and the positions of its messages.
class ChunkBuilder {
 public:
  void add(const Schema& schema) { put_schema(records_, schema); }
  void add(const Channel& channel) { put_channel(records_, channel); }
  void add(const MessageHead& head, std::span<const std::byte> data);

  [[nodiscard]] bool empty() const { return records_.size() == 0; }
  [[nodiscard]] std::size_t size() const { return records_.size(); }
  [[nodiscard]] std::span<const std::byte> records() const { return records_.view(); }
  [[nodiscard]] std::uint64_t start_time() const { return start_time_; }  // 0 without messages
  [[nodiscard]] std::uint64_t end_time() const { return end_time_; }

  // Appends the message indexes, which will be at `offset` in the file, and stores their positions
  // in `chunk`.
  void put_message_indexes(RecordBuilder& to, std::uint64_t offset, WrittenChunk& chunk) const;

  void clear();

 private:
  using Entry = std::pair<std::uint64_t, std::uint64_t>;  // log time, offset in the records

  RecordBuilder records_;
  std::map<std::uint16_t, std::vector<Entry>> entries_;
  std::uint64_t start_time_ = 0;
  std::uint64_t end_time_ = 0;
};

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

struct Writer::State {
  // The position of a group of records of one kind in the summary.
  struct SummaryGroup {
    Opcode opcode{};
    std::uint64_t start = 0;
    std::uint64_t length = 0;
  };

  State(const std::filesystem::path& file, WriterOptions wanted)
      : path(file), options(std::move(wanted)), output(file), compressor(options.compression) {}

  void check_usable() const;
  void put(std::span<const std::byte> bytes, Crc32* crc);
  void write_start();
  void finish_chunk();
  void write_end();
  void write_summary();
  template <typename All, typename Put>
  void write_group(Opcode opcode, const All& all, const Put& put_one);

  std::filesystem::path path;
  WriterOptions options;
  OutputFile output;
  Compressor compressor;
  bool failed = false;
  bool closed = false;
  std::uint64_t offset = 0;  // bytes written
  Crc32 data_crc;
  Crc32 summary_crc;
  RecordBuilder records;  // records being built
  ChunkBuilder chunk;
  std::vector<std::byte> compressed;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<WrittenChunk> chunks;
  Statistics statistics;
  std::vector<SummaryGroup> groups;
};

void Writer::State::check_usable() const {
  if (failed) throw InputError(path.string() + ": an earlier write failed; the file is incomplete");
  assert(!closed && "nothing may be written after close()");
}

void Writer::State::put(std::span<const std::byte> bytes, Crc32* crc) {
  failed = true;
  output.write(bytes.data(), bytes.size());
  failed = false;
  offset += bytes.size();
  if (crc != nullptr) crc->add(bytes);
}

void Writer::State::write_start() {
  records.bytes(magic_bytes);
  records.begin(Opcode::header);
  records.text(options.profile);
  records.text("penumbra " PENUMBRA_VERSION);
  records.end();
  put(records.view(), &data_crc);
}

void Writer::State::finish_chunk() {
  if (chunk.empty()) return;
  const auto raw = chunk.records();
  ChunkHead head{.start_time = chunk.start_time(),
                 .end_time = chunk.end_time(),
                 .uncompressed_size = raw.size(),
                 .uncompressed_crc = crc32(raw),
                 .compression = {},
                 .records_size = raw.size()};
  auto stored = raw;
  if (options.compression != Compression::none) {
    compressor.compress(raw, compressed);
    if (compressed.size() < raw.size() && raw.size() <= most_decompressed(compressed.size())) {
      stored = compressed;
      head.compression = to_string(options.compression);
      head.records_size = stored.size();
    }
  }
  WrittenChunk written;
  written.head = head;
  written.offset = offset;
  records.clear();
  put_chunk_head(records, head);
  put(records.view(), &data_crc);
  put(stored, &data_crc);
  written.length = offset - written.offset;

  records.clear();
  chunk.put_message_indexes(records, offset, written);
  put(records.view(), &data_crc);
  chunks.push_back(std::move(written));
  ++statistics.chunks;
  chunk.clear();
}

void Writer::State::write_end() {
  records.clear();
  records.begin(Opcode::data_end);
  records.number(data_crc.value());
  records.end();
  put(records.view(), nullptr);
}

template <typename All, typename Put>
void Writer::State::write_group(Opcode opcode, const All& all, const Put& put_one) {
  records.clear();
  for (const auto& one : all) put_one(records, one);
  if (records.size() == 0) return;
  groups.push_back({opcode, offset, records.size()});
  put(records.view(), &summary_crc);
}

void Writer::State::write_summary() {
  const std::uint64_t start = offset;
  write_group(Opcode::schema, schemas,
              [](RecordBuilder& to, const auto& schema) { put_schema(to, schema.second); });
  write_group(Opcode::channel, channels,
              [](RecordBuilder& to, const auto& channel) { put_channel(to, channel.second); });
  write_group(Opcode::statistics, std::span(&statistics, 1), put_statistics);
  write_group(Opcode::chunk_index, chunks, put_chunk_index);

  const std::uint64_t offsets_start = offset;
  records.clear();
  for (const SummaryGroup& group : groups) {
    records.begin(Opcode::summary_offset);
    records.number(static_cast<std::uint8_t>(group.opcode));
    records.number(group.start);
    records.number(group.length);
    records.end();
  }
  records.number(static_cast<std::uint8_t>(Opcode::footer));
  records.number(footer_bytes);
  records.number(start);
  records.number(offsets_start);
  summary_crc.add(records.view());
  records.number(summary_crc.value());
  records.bytes(magic_bytes);
  put(records.view(), nullptr);
}

Writer::Writer(const std::filesystem::path& file, WriterOptions options)
    : state_(std::make_unique<State>(file, std::move(options))) {
  assert(state_->options.chunk_size <= most_chunk_size);
  state_->write_start();
}

Writer::~Writer() = default;

std::uint16_t Writer::add_schema(std::string name, std::string encoding, std::string data) {
  State& s = *state_;
  s.check_usable();
  if (s.schemas.size() >= std::numeric_limits<std::uint16_t>::max())
    throw InputError(s.path.string() + ": MCAP holds at most 65535 schemas");
  const auto id = static_cast<std::uint16_t>(s.schemas.size() + 1);
  const auto& schema =
      s.schemas.emplace(id, Schema{id, std::move(name), std::move(encoding), std::move(data)})
          .first->second;
  s.chunk.add(schema);
  ++s.statistics.schemas;
  return id;
}

std::uint16_t Writer::add_channel(std::string topic, std::string message_encoding,
                                  std::uint16_t schema_id,
                                  std::map<std::string, std::string> metadata) {
  State& s = *state_;
  s.check_usable();
  assert(schema_id == 0 || s.schemas.contains(schema_id));
  if (s.channels.size() > std::numeric_limits<std::uint16_t>::max())
    throw InputError(s.path.string() + ": MCAP holds at most 65536 channels");
  const auto id = static_cast<std::uint16_t>(s.channels.size());
  const auto& channel = s.channels
                            .emplace(id, Channel{id, schema_id, std::move(topic),
                                                 std::move(message_encoding), std::move(metadata)})
                            .first->second;
  s.chunk.add(channel);
  ++s.statistics.channels;
  return id;
}

void Writer::write(std::uint16_t channel, std::int64_t log_time, std::int64_t publish_time,
                   std::uint32_t sequence, std::span<const std::byte> data) {
  State& s = *state_;
  s.check_usable();
  const auto known = s.channels.find(channel);
  assert(known != s.channels.end());
  if (log_time < 0 || publish_time < 0)
    throw InputError(s.path.string() + ": a message of " + known->second.topic + " has the time " +
                     std::to_string(std::min(log_time, publish_time)) +
                     " ns; MCAP holds none before 1970");
  if (data.size() >= most_chunk_size)
    throw InputError(s.path.string() + ": a message of " + known->second.topic + " has " +
                     std::to_string(data.size()) + " bytes; less than 512 MB are written");
  const auto time = static_cast<std::uint64_t>(log_time);
  // A message that would make the chunk too large begins the next chunk.
  if (s.chunk.size() + data.size() > most_chunk_size) s.finish_chunk();
  s.chunk.add({channel, sequence, time, static_cast<std::uint64_t>(publish_time)}, data);
  Statistics& all = s.statistics;
  all.start_time = all.messages == 0 ? time : std::min(all.start_time, time);
  all.end_time = std::max(all.end_time, time);
  ++all.messages;
  ++all.channel_messages[channel];
  if (s.chunk.size() >= s.options.chunk_size) s.finish_chunk();
}

void Writer::close() {
  State& s = *state_;
  s.check_usable();
  s.finish_chunk();
  s.write_end();
  s.write_summary();
  s.failed = true;
  s.output.close();
  s.failed = false;
  s.closed = true;
}

}  // namespace penumbra::io::mcap
