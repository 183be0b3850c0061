// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <io/mcap/chunk_loader.hpp>

namespace penumbra::io::mcap {

/// Gives a file's messages by log time, those of one time in the file's order. Holds the chunks
/// that overlap in time; where they take too much memory, those that are needed last are dropped
/// and loaded again in their turn.
class ChunkMerger {
 public:
  static constexpr std::size_t most_held_bytes = std::size_t{96} << 20;

  struct Item {
    MessageHead head;
    std::span<const std::byte> data;  ///< valid until the next call
    std::uint64_t place = 0;          ///< offset of its chunk
  };

  /// All must outlive this. `held_bytes`: of chunks in memory, unless a single one has more.
  ChunkMerger(const InputFile& file, FileLayout& layout, FaultLog& faults,
              std::size_t held_bytes = most_held_bytes);

  [[nodiscard]] std::optional<Item> next();

  /// Takes in the schemas and channels of chunks that may hold ones not yet known.
  void complete_definitions();

 private:
  struct Run {  // a chunk whose messages are being given
    const MessagePlace* place = nullptr;
    std::size_t next = 0;  // of its messages
    std::size_t count = 0;
    std::uint64_t time = 0;              // of the next one
    std::unique_ptr<LoadedChunk> chunk;  // null: dropped meanwhile
  };

  static bool later(const Run& a, const Run& b);
  void start(const MessagePlace& place);
  [[nodiscard]] bool reload(Run& run);
  void advance();
  void push(Run run);
  void hold_less();
  void release(std::unique_ptr<LoadedChunk> chunk);
  [[nodiscard]] std::unique_ptr<LoadedChunk> load(const MessagePlace& place);

  ChunkLoader loader_;
  FileLayout* layout_;
  FaultLog* faults_;
  std::size_t most_held_;
  std::vector<const MessagePlace*> order_;  // by start
  std::size_t next_place_ = 0;
  std::vector<Run> runs_;  // a heap: the earliest message in front
  Run current_;            // whose message was given last; no place: none
  std::uint64_t last_time_ = 0;
  std::size_t held_ = 0;
  std::vector<std::unique_ptr<LoadedChunk>> spare_;
};

}  // namespace penumbra::io::mcap
