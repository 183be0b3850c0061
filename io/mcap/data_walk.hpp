// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>

#include <io/mcap/file_layout.hpp>
#include <io/mcap/file_window.hpp>

namespace penumbra::io::mcap {

/// Walks through the records of a file's data section without reading the messages.
class DataWalk {
 public:
  DataWalk(FileWindow& window, FileLayout& layout, FaultLog& faults)
      : window_(&window), layout_(&layout), faults_(&faults) {}

  /// Adds the records between two offsets to the layout and stops at the end of the data section.
  /// After damage it continues at the next recognisable chunk.
  void run(std::uint64_t begin, std::uint64_t end);

  /// Returns whether the end of the data section was reached.
  [[nodiscard]] bool has_end() const { return has_end_; }
  /// Returns whether damage was found.
  [[nodiscard]] bool damaged() const { return damaged_; }

 private:
  [[nodiscard]] std::string fault_of(const RecordHead& head, std::uint64_t left) const;
  void take(const RecordHead& head, std::uint64_t offset);
  void skip(const RecordHead& head, std::uint64_t offset, const std::string& fault);
  void take_definition(const RecordHead& head, std::uint64_t offset);
  void take_message(const RecordHead& head, std::uint64_t offset);
  void take_chunk(const RecordHead& head, std::uint64_t offset);
  void take_message_index(std::uint64_t offset);
  [[nodiscard]] std::uint64_t find_chunk(std::uint64_t from, std::uint64_t end);
  [[nodiscard]] bool is_chunk(std::span<const std::byte> bytes, std::uint64_t left) const;
  [[nodiscard]] std::string fault_of_skipped(const RecordHead& head, std::uint64_t offset);

  FileWindow* window_;
  FileLayout* layout_;
  FaultLog* faults_;
  bool has_end_ = false;
  bool damaged_ = false;
  std::set<Opcode> reported_;  // unknown record kinds that were reported
};

}  // namespace penumbra::io::mcap
