// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <io/mcap/chunk_loader.hpp>

namespace penumbra::io::mcap {

/// Returns a file's messages by log time, then in the file's order. It holds the chunks that
/// overlap in time.
class ChunkMerger {
 public:
  struct Item {
    MessageHead head;
    std::span<const std::byte> data;  ///< valid until the next call
    std::uint64_t place = 0;          ///< offset of the message's chunk
  };

  /// All arguments must outlive this.
  ChunkMerger(const InputFile& file, FileLayout& layout, FaultLog& faults);

  [[nodiscard]] std::optional<Item> next();

  /// Reads the schemas and channels of chunks that may define missing ones.
  void complete_definitions();

 private:
  struct Run {  // a chunk whose messages are being returned
    const MessagePlace* place = nullptr;
    std::size_t next = 0;    // index of the next message
    std::uint64_t time = 0;  // log time of the next message
    std::unique_ptr<LoadedChunk> chunk;
  };

  static bool later(const Run& a, const Run& b);
  void start(const MessagePlace& place);
  void advance();
  void push(Run run);
  void release(std::unique_ptr<LoadedChunk> chunk);
  [[nodiscard]] std::unique_ptr<LoadedChunk> load(const MessagePlace& place);

  ChunkLoader loader_;
  FileLayout* layout_;
  FaultLog* faults_;
  std::vector<const MessagePlace*> order_;  // by start time
  std::size_t next_place_ = 0;
  std::vector<Run> runs_;  // a heap with the earliest message first
  Run current_;            // the run of the last returned message; no place: none
  std::uint64_t last_time_ = 0;
  std::vector<std::unique_ptr<LoadedChunk>> spare_;
};

}  // namespace penumbra::io::mcap
