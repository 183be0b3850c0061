// SPDX-License-Identifier: Apache-2.0
// The records of MCAP in the file: https://mcap.dev/spec
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <io/mcap/records.hpp>

namespace penumbra::io::mcap {

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
inline constexpr std::uint64_t message_head_bytes = 22;  // channel, sequence and times
inline constexpr std::uint64_t footer_bytes = 20;        // size of the content
inline constexpr std::uint64_t end_bytes = record_head_bytes + footer_bytes + magic_bytes.size();
inline constexpr std::uint64_t most_chunk_head_bytes = 72;  // with a compression name of 32 bytes

/// The limit for all schemas and channels of a file; those of ROS 2 have a few kilobytes each. It
/// also limits every other record in memory, except messages and chunks.
inline constexpr std::uint64_t max_definition_bytes = std::uint64_t{64} << 20;

struct RecordHead {
  Opcode opcode{};
  std::uint64_t length = 0;  // of the content after the head
};

/// Parses a record's head from record_head_bytes bytes.
[[nodiscard]] RecordHead parse_head(std::span<const std::byte> bytes);

struct HeaderRecord {
  std::string profile;
  std::string library;
};

struct FooterRecord {
  std::uint64_t summary_start = 0;
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  // 0: none
};

struct ChunkHead {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: none
  std::string compression;
  std::uint64_t records_size = 0;    // compressed
  std::uint64_t records_offset = 0;  // from the start of the content
};

struct ChunkIndexRecord {
  std::uint64_t start_time = 0;
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  // of the whole chunk record
  std::vector<std::uint16_t> channels;
  std::uint64_t message_index_length = 0;
};

struct MessageHead {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
};

// Each function parses a record's content. It returns nothing if the fields exceed the content.
// Bytes after the last field belong to later versions and are ignored.
[[nodiscard]] std::optional<HeaderRecord> parse_header(std::span<const std::byte> content);
[[nodiscard]] std::optional<FooterRecord> parse_footer(std::span<const std::byte> content);
[[nodiscard]] std::optional<Schema> parse_schema(std::span<const std::byte> content);
[[nodiscard]] std::optional<Channel> parse_channel(std::span<const std::byte> content);
[[nodiscard]] std::optional<Statistics> parse_statistics(std::span<const std::byte> content);
[[nodiscard]] std::optional<ChunkIndexRecord> parse_chunk_index(std::span<const std::byte> content);
[[nodiscard]] std::optional<MessageHead> parse_message_head(std::span<const std::byte> content);
/// Parses a chunk's head. Needs at most most_chunk_head_bytes of the content.
[[nodiscard]] std::optional<ChunkHead> parse_chunk_head(std::span<const std::byte> content);

}  // namespace penumbra::io::mcap
