// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

#include <penumbra/base/version.hpp>

#include <io/files/disk_file.hpp>
#include <io/mcap/records.hpp>
#include <io/mcap/writer.hpp>

namespace penumbra::io::mcap {

constexpr std::size_t most_chunk_size = max_record_bytes / 2;

struct Writer::State {
  State(const std::filesystem::path& file, WriterOptions wanted)
      : path(file), options(std::move(wanted)), output(file), compressor(options.compression) {}

  void check_usable() const;
  void put(std::span<const std::byte> bytes, std::uint32_t* crc);
  void put_records(std::uint32_t* crc);
  void write_start();
  void add_to_chunk(const MessageHead& head, std::span<const std::byte> data);
  void finish_chunk();
  void write_message_indexes(ChunkIndex& index);
  void write_end();
  void write_summary();
  template <typename All, typename Record>
  void put_group(const All& all, const Record& record_of);

  std::filesystem::path path;
  WriterOptions options;
  OutputFile output;
  Compressor compressor;
  bool failed = false;
  bool closed = false;
  std::uint64_t offset = 0;  // bytes written
  std::uint32_t data_crc = 0;
  RecordBuilder records;  // records being built
  std::vector<std::byte> compressed;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  Statistics statistics;
  std::vector<ChunkIndex> chunks;

  // The open chunk.
  RecordBuilder chunk;
  std::uint64_t chunk_start = 0, chunk_end = 0;           // log times; 0 without messages
  using Entry = std::pair<std::uint64_t, std::uint64_t>;  // log time, offset in the chunk
  std::map<std::uint16_t, std::vector<Entry>> entries;    // by channel

  // The summary.
  RecordBuilder summary, summary_offsets;
};

void Writer::State::check_usable() const {
  if (failed) throw InputError(path.string() + ": an earlier write failed; the file is incomplete");
  assert(!closed && "nothing may be written after close()");
}

void Writer::State::put(std::span<const std::byte> bytes, std::uint32_t* crc) {
  failed = true;
  output.write(bytes.data(), bytes.size());
  failed = false;
  offset += bytes.size();
  if (crc != nullptr) *crc = crc32(bytes, *crc);
}

// Writes `records` and clears them.
void Writer::State::put_records(std::uint32_t* crc) {
  put(records.view(), crc);
  records.clear();
}

void Writer::State::write_start() {
  records.bytes(magic_bytes);
  records.put(Header{options.profile, "penumbra " PENUMBRA_VERSION});
  put_records(&data_crc);
}

void Writer::State::add_to_chunk(const MessageHead& head, std::span<const std::byte> data) {
  chunk_start = entries.empty() ? head.log_time : std::min(chunk_start, head.log_time);
  chunk_end = std::max(chunk_end, head.log_time);
  entries[head.channel].emplace_back(head.log_time, chunk.size());
  chunk.record(Opcode::message, [&] {
    MessageHead::layout(chunk, head);
    chunk.bytes(data);
  });
}

void Writer::State::finish_chunk() {
  if (chunk.size() == 0) return;
  const auto raw = chunk.view();
  ChunkHead head{.start_time = chunk_start,
                 .end_time = chunk_end,
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
  ChunkIndex index{.start_time = head.start_time,
                   .end_time = head.end_time,
                   .offset = offset,
                   .length = record_head_bytes + head.records_offset() + head.records_size,
                   .index_offsets = {},
                   .index_length = 0,
                   .compression = head.compression,
                   .records_size = head.records_size,
                   .uncompressed_size = head.uncompressed_size};
  // The compressed records follow the head and are elsewhere in memory.
  records(static_cast<std::uint8_t>(Opcode::chunk), index.length - record_head_bytes);
  ChunkHead::layout(records, head);
  put_records(&data_crc);
  put(stored, &data_crc);
  write_message_indexes(index);
  chunks.push_back(std::move(index));
  ++statistics.chunks;
  chunk.clear();
  entries.clear();
  chunk_start = chunk_end = 0;
}

void Writer::State::write_message_indexes(ChunkIndex& index) {
  for (const auto& [channel, of_channel] : entries) {
    index.index_offsets.emplace(channel, offset + records.size());
    records.record(Opcode::message_index, [&, channel = channel, &all = of_channel] {
      records(channel);
      records.counted<std::uint32_t>([&] {
        for (const auto& [time, at] : all) records(time, at);
      });
    });
  }
  index.index_length = records.size();
  put_records(&data_crc);
}

void Writer::State::write_end() {
  records.record(Opcode::data_end, [&] { records(data_crc); });
  put_records(nullptr);
}

// Adds records of one kind to the summary.
template <typename All, typename Record>
void Writer::State::put_group(const All& all, const Record& record_of) {
  if (all.empty()) return;
  const std::uint64_t start = summary.size();
  for (const auto& one : all) summary.put(record_of(one));
  const auto opcode =
      static_cast<std::uint8_t>(std::remove_cvref_t<decltype(record_of(*all.begin()))>::opcode);
  summary_offsets.record(Opcode::summary_offset,
                         [&] { summary_offsets(opcode, offset + start, summary.size() - start); });
}

void Writer::State::write_summary() {
  const auto second = [](const auto& entry) -> const auto& { return entry.second; };
  const auto itself = [](const auto& entry) -> const auto& { return entry; };
  put_group(schemas, second);
  put_group(channels, second);
  put_group(std::span(&statistics, 1), itself);
  put_group(chunks, itself);
  const Footer footer{.summary_start = offset, .summary_offset_start = offset + summary.size()};
  summary.bytes(summary_offsets.view());
  summary.put(footer);
  // The footer ends with the checksum of all before it.
  const auto checked = summary.view().first(summary.size() - sizeof footer.summary_crc);
  put(checked, nullptr);
  records(crc32(checked));
  records.bytes(magic_bytes);
  put_records(nullptr);
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
  s.chunk.put(schema);
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
  s.chunk.put(channel);
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
  s.add_to_chunk({channel, sequence, time, static_cast<std::uint64_t>(publish_time)}, data);
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
