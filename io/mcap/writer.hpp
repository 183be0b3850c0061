// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <io/mcap/compression.hpp>

namespace penumbra::io::mcap {

struct WriterOptions {
  Compression compression = Compression::zstd;
  /// Bytes of messages after which a chunk is closed, before compression; at most 512 MB. What
  /// stands in an open chunk is lost when the program ends without close().
  std::size_t chunk_size = std::size_t{1} << 20;
  std::string profile;  ///< "ros2" for bags
};

/// Writes an MCAP file of chunks with message and chunk index, summary, statistics and checksums.
/// The same calls give the same bytes. Chunks that do not shrink, and such of more than
/// 64 MB that shrink more than 64-fold, are stored as they are.
/// Whatever the system refuses (a full disk) throws InputError that names the file; the writer then
/// refuses all further calls. Without close() the file ends behind its last whole chunk.
class Writer {
 public:
  Writer(const std::filesystem::path& file, WriterOptions options);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Answers the schema's id. At most 65,535 schemas; throws InputError for more.
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);

  /// Answers the channel's id. `schema_id`: of add_schema(), or 0 for none. At most 65,536
  /// channels; throws InputError for more.
  std::uint16_t add_channel(std::string topic, std::string message_encoding,
                            std::uint16_t schema_id,
                            std::map<std::string, std::string> metadata = {});

  /// `channel`: of add_channel(). Times in nanoseconds since 1970; throws InputError for earlier
  /// ones, and for messages of 512 MB and more. Messages may come in any order.
  void write(std::uint16_t channel, std::int64_t log_time, std::int64_t publish_time,
             std::uint32_t sequence, std::span<const std::byte> data);

  /// Finishes the file. Nothing may be written afterwards.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io::mcap
