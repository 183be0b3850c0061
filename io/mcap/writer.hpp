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
  /// A chunk is closed after this many bytes of messages before compression; at most 512 MB. The
  /// open chunk is lost if the program ends without close().
  std::size_t chunk_size = std::size_t{1} << 20;
  std::string profile;  ///< "ros2" for bags
};

/// Writes an MCAP file of chunks with message and chunk index, summary, statistics and checksums.
/// The same calls give the same bytes. Chunks that do not shrink, and chunks of more than 64 MB
/// that shrink more than 64-fold, are stored uncompressed.
///
/// A system error (for example, a full disk) throws InputError that names the file; all further
/// calls are refused. Without close() the file ends after its last whole chunk.
class Writer {
 public:
  Writer(const std::filesystem::path& file, WriterOptions options);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Adds a schema and returns its id. Throws InputError for more than 65,535 schemas.
  std::uint16_t add_schema(std::string name, std::string encoding, std::string data);

  /// Adds a channel and returns its id. `schema_id`: of add_schema(), or 0 for none. Throws
  /// InputError for more than 65,536 channels.
  std::uint16_t add_channel(std::string topic, std::string message_encoding,
                            std::uint16_t schema_id,
                            std::map<std::string, std::string> metadata = {});

  /// Writes a message. `channel`: of add_channel(). Times are nanoseconds since 1970. Throws
  /// InputError for earlier times and for messages of 512 MB and more. Messages may come in any
  /// order.
  void write(std::uint16_t channel, std::int64_t log_time, std::int64_t publish_time,
             std::uint32_t sequence, std::span<const std::byte> data);

  /// Finishes the file. Do not write afterwards.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io::mcap
