// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <io/mcap/records.hpp>

namespace penumbra::io::mcap {

struct Message {
  std::uint16_t channel = 0;  ///< id
  std::uint32_t sequence = 0;
  std::int64_t log_time = 0;      ///< time of recording, nanoseconds
  std::int64_t publish_time = 0;  ///< nanoseconds
  std::span<const std::byte> data;
};

/// A part of a file that is unreadable or wrong.
struct Fault {
  std::uint64_t offset = 0;  ///< offset in the file
  std::string what;          ///< one line: the fault and what was left out
};

/// Reads an MCAP file: chunks that are uncompressed, lz4 or zstd, or no chunks; with or without
/// index and summary; also unfinished or damaged files. Every readable part is read. Each damaged
/// chunk and a truncation is a fault.
///
/// Memory holds the chunks that overlap in time, at most 2 GiB. It follows the actual content of
/// the file, not the sizes that it claims. Messages outside of chunks have no checksum.
class Reader {
 public:
  /// Throws InputError that names the file if it cannot be read or does not begin like MCAP.
  explicit Reader(const std::filesystem::path& file);
  ~Reader();

  [[nodiscard]] const std::string& profile() const;  ///< "ros2"
  [[nodiscard]] const std::string& library() const;  ///< the library that wrote the file

  /// Returns the schemas by id. All schemas of messages are there from the start, except in files
  /// with a wrong index.
  [[nodiscard]] const std::map<std::uint16_t, Schema>& schemas() const;
  [[nodiscard]] const std::map<std::uint16_t, Channel>& channels() const;

  /// Returns the writer's statistics, if the file has them.
  [[nodiscard]] const std::optional<Statistics>& statistics() const;

  /// Reads the next message by log time, then in the file's order. Its data is valid until the next
  /// call. Returns false at the end. Messages of undefined channels are left out, which is a fault.
  /// Throws InputError if more than 2 GiB of chunks overlap in time.
  bool next(Message& message);

  /// Returns the faults found so far, in the order of discovery. The list is complete at the end.
  [[nodiscard]] const std::vector<Fault>& faults() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra::io::mcap
