// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <io/files/disk_file.hpp>
#include <io/mcap/compression.hpp>
#include <io/mcap/file_layout.hpp>

namespace penumbra::io::mcap {

/// A chunk in memory, or a range of records outside of chunks.
struct LoadedChunk {
  struct Entry {
    std::uint64_t log_time = 0;
    std::uint64_t content = 0;  ///< offset of the message's content in `records`
    std::uint64_t length = 0;   ///< of the content
  };

  std::vector<std::byte> records;
  std::vector<Entry> messages;  ///< by log time, then in the file's order

  [[nodiscard]] std::size_t footprint() const {
    return records.capacity() + messages.capacity() * sizeof(Entry);
  }
};

/// Reads, decompresses and checks chunks.
class ChunkLoader {
 public:
  /// The file must outlive this.
  explicit ChunkLoader(const InputFile& file) : file_(&file) {}

  /// Loads the records at `place` and adds their schemas and channels to `definitions`. A damaged
  /// chunk gives no messages; a chunk with damaged records gives the messages before the damage.
  /// Each is a fault.
  void load(const MessagePlace& place, LoadedChunk& chunk, Definitions& definitions,
            FaultLog& faults);

 private:
  [[nodiscard]] std::string load_records(const MessagePlace& place,
                                         std::vector<std::byte>& records);
  [[nodiscard]] bool read(std::uint64_t offset, std::uint64_t count,
                          std::vector<std::byte>& to) const;

  const InputFile* file_;
  Decompressor decompressor_;
  std::vector<std::byte> compressed_;
};

}  // namespace penumbra::io::mcap
