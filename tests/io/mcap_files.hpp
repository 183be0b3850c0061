// SPDX-License-Identifier: Apache-2.0
// MCAP files for tests: put together by the specification's words, and read into plain values.
#pragma once

#include "files.hpp"

#include <sstream>
#include <type_traits>

#include <zlib.h>

#include <io/mcap/reader.hpp>
#include <io/mcap/writer.hpp>

namespace penumbra::test {

namespace mcap_file {

inline const std::string magic = "\x89MCAP0\r\n";

inline std::string u16(std::uint16_t value) { return raw(value); }
inline std::string u32(std::uint64_t value) { return raw(static_cast<std::uint32_t>(value)); }
inline std::string u64(std::uint64_t value) { return raw(value); }
inline std::string text(const std::string& value) { return u32(value.size()) + value; }
inline std::uint32_t crc(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

inline std::string record(int opcode, const std::string& content) {
  return static_cast<char>(opcode) + u64(content.size()) + content;
}
inline std::string header() { return record(0x01, text("ros2") + text("by hand")); }
inline std::string schema(std::uint16_t id, const std::string& name) {
  return record(0x03, u16(id) + text(name) + text("ros2msg") + text("int32 a\n"));
}
inline std::string channel(std::uint16_t id, std::uint16_t schema_id, const std::string& topic) {
  return record(0x04, u16(id) + u16(schema_id) + text(topic) + text("cdr") + text(""));
}
inline std::string message(std::uint16_t channel_id, std::uint64_t time) {
  return record(0x05, u16(channel_id) + u32(time) + u64(time) + u64(time) + "data");
}
inline std::string chunk(std::uint64_t start, std::uint64_t end, const std::string& records) {
  return record(0x06, u64(start) + u64(end) + u64(records.size()) + u32(crc(records)) + text("") +
                          u64(records.size()) + records);
}
inline std::string compressed_chunk(const std::string& compression, std::uint64_t size,
                                    const std::string& records) {
  return record(0x06, u64(1) + u64(2) + u64(size) + u32(0) + text(compression) +
                          u64(records.size()) + records);
}
inline std::string chunk_index(std::uint64_t start, std::uint64_t end, std::uint64_t offset,
                               std::uint64_t length) {
  return record(0x08, u64(start) + u64(end) + u64(offset) + u64(length) + u32(0) + u64(0) +
                          text("") + u64(0) + u64(0));
}
inline std::string data_end() { return record(0x0f, u32(0)); }
inline std::string footer(std::uint64_t summary_start = 0) {
  return record(0x02, u64(summary_start) + u64(0) + u32(0)) + magic;
}
/// A whole file around `data`, with `summary` where there is one.
inline std::string file(const std::string& data, const std::string& summary = "") {
  const std::string start = magic + header() + data + data_end();
  return start + summary + footer(summary.empty() ? 0 : start.size());
}
/// Offset of the first record behind the header.
inline std::uint64_t data_start() { return magic.size() + header().size(); }

}  // namespace mcap_file

/// A message with its channel, so that it can be compared.
struct RecordedMessage {
  std::string topic, schema;
  std::uint32_t sequence = 0;
  std::int64_t log_time = 0, publish_time = 0;
  std::string data;

  auto operator<=>(const RecordedMessage&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const RecordedMessage& message) {
  return out << message.topic << " " << message.schema << " #" << message.sequence << " at "
             << message.log_time << " with " << message.data.size() << " bytes";
}

struct McapContents {
  std::vector<RecordedMessage> messages;
  std::vector<std::string> faults;
  std::vector<std::uint64_t> fault_offsets;
};

inline std::string bytes_of(std::span<const std::byte> data) {
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

inline std::span<const std::byte> as_bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

inline RecordedMessage recorded(const io::mcap::Reader& reader, const io::mcap::Message& message) {
  const auto& channel = reader.channels().at(message.channel);
  const auto schema = reader.schemas().find(channel.schema_id);
  return {channel.topic,        schema == reader.schemas().end() ? "-" : schema->second.name,
          message.sequence,     message.log_time,
          message.publish_time, bytes_of(message.data)};
}

inline McapContents read_mcap(const std::filesystem::path& file) {
  McapContents all;
  io::mcap::Reader reader(file);
  for (io::mcap::Message message; reader.next(message);)
    all.messages.push_back(recorded(reader, message));
  for (const auto& fault : reader.faults()) {
    EXPECT_EQ(fault.what.find('\n'), std::string::npos);
    all.faults.push_back(fault.what);
    all.fault_offsets.push_back(fault.offset);
  }
  io::mcap::Message none;
  EXPECT_FALSE(reader.next(none));
  return all;
}

/// `messages` on channels of their topics, in their order.
inline void write_mcap(const std::filesystem::path& file, const io::mcap::WriterOptions& options,
                       const std::vector<RecordedMessage>& messages) {
  io::mcap::Writer writer(file, options);
  std::map<std::string, std::uint16_t> schemas, channels;
  for (const RecordedMessage& m : messages) {
    if (!schemas.contains(m.schema) && m.schema != "-")
      schemas[m.schema] = writer.add_schema(m.schema, "ros2msg", "int32 of_" + m.schema + "\n");
    if (!channels.contains(m.topic)) {
      const std::uint16_t schema = m.schema == "-" ? 0 : schemas[m.schema];
      channels[m.topic] = writer.add_channel(m.topic, "cdr", schema, {{"qos", m.topic}});
    }
    writer.write(channels[m.topic], m.log_time, m.publish_time, m.sequence, as_bytes(m.data));
  }
  writer.close();
}

/// As a reader gives them.
inline std::vector<RecordedMessage> by_time(std::vector<RecordedMessage> messages) {
  std::stable_sort(
      messages.begin(), messages.end(),
      [](const RecordedMessage& a, const RecordedMessage& b) { return a.log_time < b.log_time; });
  return messages;
}

}  // namespace penumbra::test
