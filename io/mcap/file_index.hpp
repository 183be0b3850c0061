// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <io/files/disk_file.hpp>
#include <io/mcap/reader.hpp>

namespace penumbra::io::mcap {

/// The faults of a file, each once, in the order of discovery. If there are very many, only the
/// first are kept.
class FaultLog {
 public:
  void add(std::uint64_t offset, const std::string& what);
  [[nodiscard]] const std::vector<Fault>& all() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

/// A place of messages: a chunk, or a range of records outside of chunks.
struct MessagePlace {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;      ///< of the whole chunk record or of the range
  std::uint64_t start_time = 0;  ///< earliest log time, by the file
  bool loose = false;            ///< outside of chunks
  std::optional<std::vector<std::uint16_t>> channels =
      {};  ///< with messages in the chunk, if known
};

/// The content of a file, except its messages.
struct FileIndex {
  Header header;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::optional<Statistics> statistics;
  bool summary_has_channels = false;
  std::vector<MessagePlace> places;  ///< by offset

  /// Adds a schema or channel record that is at `offset` or in the chunk there. The first
  /// definition of an id holds; a different one with the same id is a fault.
  void define(Opcode opcode, std::span<const std::byte> content, std::uint64_t offset,
              FaultLog& faults);

  /// Returns whether a place may have messages of channels that are not defined yet.
  [[nodiscard]] bool may_define(const MessagePlace& place) const;

 private:
  [[nodiscard]] bool is_complete(std::uint16_t channel) const;

  std::uint64_t definition_bytes_ = 0;
};

/// Finds all records in an MCAP file after its magic: by the index and by walking through the parts
/// that are not indexed, or by walking through the file if there is no index. Damage and truncation
/// are reported as faults.
[[nodiscard]] FileIndex read_index(const InputFile& file, FaultLog& faults);

}  // namespace penumbra::io::mcap
