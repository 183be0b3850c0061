// SPDX-License-Identifier: Apache-2.0
// The records of MCAP: https://mcap.dev/spec. A record's layout() passes its fields, in the order
// of the file, to a RecordParser or a RecordBuilder.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace penumbra::io::mcap {

static_assert(std::endian::native == std::endian::little, "numbers are copied unchanged");

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0a,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f
};

inline constexpr std::array<std::byte, 8> magic_bytes{
    std::byte{0x89}, std::byte{'M'}, std::byte{'C'},  std::byte{'A'},
    std::byte{'P'},  std::byte{'0'}, std::byte{'\r'}, std::byte{'\n'}};

inline constexpr std::uint64_t record_head_bytes = 9;    // opcode and length
inline constexpr std::uint64_t message_head_bytes = 22;  // of MessageHead

/// The largest record. A record that claims more is damaged.
inline constexpr std::uint64_t max_record_bytes = std::uint64_t{1} << 30;

/// The first bytes of a record.
struct RecordHead {
  Opcode opcode{};
  std::uint64_t length = 0;  ///< of the content after the head
};

struct Header {
  static constexpr Opcode opcode = Opcode::header;
  static void layout(auto& io, auto& r) { io(r.profile, r.library); }

  std::string profile, library;
};

struct Footer {
  static constexpr Opcode opcode = Opcode::footer;
  static void layout(auto& io, auto& r) {
    io(r.summary_start, r.summary_offset_start, r.summary_crc);
  }

  std::uint64_t summary_start = 0;  ///< 0: none
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  ///< 0: none
};

/// The message layout of channels.
struct Schema {
  static constexpr Opcode opcode = Opcode::schema;
  static void layout(auto& io, auto& r) { io(r.id, r.name, r.encoding, r.data); }

  std::uint16_t id = 0;  ///< never 0
  std::string name;      ///< "sensor_msgs/msg/Image"
  std::string encoding;  ///< of `data`: "ros2msg"
  std::string data;

  bool operator==(const Schema&) const = default;
};

/// The messages of one publisher of a topic.
struct Channel {
  static constexpr Opcode opcode = Opcode::channel;
  static void layout(auto& io, auto& r) {
    io(r.id, r.schema_id, r.topic, r.message_encoding, r.metadata);
  }

  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: none
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  std::map<std::string, std::string> metadata;

  bool operator==(const Channel&) const = default;
};

/// The start of a message record. The payload follows.
struct MessageHead {
  static void layout(auto& io, auto& r) { io(r.channel, r.sequence, r.log_time, r.publish_time); }

  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;
};

/// The start of a chunk record. The compressed records follow.
struct ChunkHead {
  static void layout(auto& io, auto& r) {
    io(r.start_time, r.end_time, r.uncompressed_size, r.uncompressed_crc, r.compression,
       r.records_size);
  }
  static constexpr std::uint64_t most_bytes = 72;  ///< with a compression name of 32 bytes

  /// Returns the offset of the compressed records in the content.
  [[nodiscard]] std::uint64_t records_offset() const { return 40 + compression.size(); }

  std::uint64_t start_time = 0, end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: none
  std::string compression;             ///< "", "lz4", "zstd"
  std::uint64_t records_size = 0;      ///< compressed
};

struct ChunkIndex {
  static constexpr Opcode opcode = Opcode::chunk_index;
  static void layout(auto& io, auto& r) {
    io(r.start_time, r.end_time, r.offset, r.length, r.index_offsets, r.index_length, r.compression,
       r.records_size, r.uncompressed_size);
  }

  std::uint64_t start_time = 0, end_time = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;                              ///< of the whole chunk record
  std::map<std::uint16_t, std::uint64_t> index_offsets;  ///< of each channel's message index
  std::uint64_t index_length = 0;                        ///< of all message indexes
  std::string compression;
  std::uint64_t records_size = 0, uncompressed_size = 0;
};

/// The statistics of the writer.
struct Statistics {
  static constexpr Opcode opcode = Opcode::statistics;
  static void layout(auto& io, auto& r) {
    io(r.messages, r.schemas, r.channels, r.attachments, r.metadata, r.chunks, r.start_time,
       r.end_time, r.channel_messages);
  }

  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
  std::uint64_t start_time = 0, end_time = 0;  ///< earliest and latest log time, nanoseconds
  std::map<std::uint16_t, std::uint64_t> channel_messages;  ///< by channel id; empty: not counted
};

/// Reads fields one after another. After a field that exceeds the bytes, ok() is false and all
/// fields are empty or 0.
class RecordParser {
 public:
  explicit RecordParser(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

  template <typename... T>
  void operator()(T&... fields) {
    (read(fields), ...);
  }

  std::span<const std::byte> bytes(std::uint64_t count) {
    ok_ = ok_ && count <= rest_.size();
    const auto taken = rest_.first(ok_ ? static_cast<std::size_t>(count) : 0);
    rest_ = ok_ ? rest_.subspan(taken.size()) : std::span<const std::byte>{};
    return taken;
  }

  RecordHead head() {
    std::uint8_t opcode = 0;
    RecordHead head;
    (*this)(opcode, head.length);
    head.opcode = Opcode{opcode};
    return head;
  }

 private:
  template <typename T>
  requires std::is_unsigned_v<T>
  void read(T& number) {
    number = 0;
    if (const auto taken = bytes(sizeof(T)); !taken.empty())
      std::memcpy(&number, taken.data(), sizeof(T));
  }
  void read(std::string& text) {
    const auto taken = counted();
    text.assign(reinterpret_cast<const char*>(taken.data()), taken.size());
  }
  template <typename K, typename V>
  void read(std::map<K, V>& map) {
    RecordParser entries(counted());
    while (entries.ok_ && !entries.rest_.empty()) {
      K key{};
      entries(key);
      entries(map[std::move(key)]);
    }
    ok_ = ok_ && entries.ok_;
  }
  std::span<const std::byte> counted() {
    std::uint32_t count = 0;
    read(count);
    return bytes(count);
  }

  std::span<const std::byte> rest_;
  bool ok_ = true;
};

/// Parses a record's content. Returns nothing if the fields exceed it. Bytes after the last field
/// belong to later versions and are ignored.
template <typename Record>
[[nodiscard]] std::optional<Record> parse(std::span<const std::byte> content) {
  RecordParser parser(content);
  std::optional<Record> record(std::in_place);
  Record::layout(parser, *record);
  if (!parser.ok()) record.reset();
  return record;
}

/// Appends records to a buffer.
class RecordBuilder {
 public:
  [[nodiscard]] std::span<const std::byte> view() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  void clear() { bytes_.clear(); }

  void bytes(std::span<const std::byte> value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
  }

  template <typename... T>
  void operator()(const T&... fields) {
    (write(fields), ...);
  }

  /// Appends a record whose content `fill()` appends.
  template <typename F>
  void record(Opcode opcode, const F& fill) {
    write(static_cast<std::uint8_t>(opcode));
    counted<std::uint64_t>(fill);
  }
  template <typename Record>
  void put(const Record& record_) {
    record(Record::opcode, [&] { Record::layout(*this, record_); });
  }

  /// Appends a byte count and what `fill()` appends.
  template <typename Count, typename F>
  void counted(const F& fill) {
    write(Count{0});
    const std::size_t start = bytes_.size();
    fill();
    const auto count = static_cast<Count>(bytes_.size() - start);
    std::memcpy(bytes_.data() + start - sizeof count, &count, sizeof count);
  }

 private:
  template <typename T>
  requires std::is_unsigned_v<T>
  void write(const T& number) { bytes(std::as_bytes(std::span(&number, 1))); }
  void write(const std::string& text) {
    counted<std::uint32_t>([&] { bytes(std::as_bytes(std::span(text))); });
  }
  template <typename K, typename V>
  void write(const std::map<K, V>& map) {
    counted<std::uint32_t>([&] {
      for (const auto& [key, value] : map) (*this)(key, value);
    });
  }

  std::vector<std::byte> bytes_;
};

}  // namespace penumbra::io::mcap
