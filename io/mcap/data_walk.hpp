// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include <io/mcap/file_layout.hpp>
#include <io/mcap/file_window.hpp>

namespace penumbra::io::mcap {

/// Goes through the records of a file's data without reading the messages.
class DataWalk {
 public:
  struct End {
    std::uint64_t offset = 0;
    std::uint32_t crc = 0;  // of all bytes before; 0: none
  };

  DataWalk(FileWindow& window, FileLayout& layout, FaultLog& faults)
      : window_(&window), layout_(&layout), faults_(&faults) {}

  /// Adds to the layout what stands between two offsets; stops where the data's end is said. Behind
  /// damage it goes on at the next chunk that can be made out.
  void run(std::uint64_t begin, std::uint64_t end);

  /// Where the file says that its data end; nothing: not met yet.
  [[nodiscard]] const std::optional<End>& end() const { return end_; }
  /// Whether damage was met.
  [[nodiscard]] bool damaged() const { return damaged_; }

 private:
  [[nodiscard]] std::string fault_of(const RecordHead& head, std::uint64_t left) const;
  void take(const RecordHead& head, std::uint64_t offset);
  void pass_over(const RecordHead& head, std::uint64_t offset, const std::string& fault);
  void take_definition(const RecordHead& head, std::uint64_t offset);
  void take_message(const RecordHead& head, std::uint64_t offset);
  void take_chunk(const RecordHead& head, std::uint64_t offset);
  void take_message_index(std::uint64_t offset);
  [[nodiscard]] std::uint64_t find_chunk(std::uint64_t from, std::uint64_t end);
  [[nodiscard]] bool is_chunk(std::span<const std::byte> bytes, std::uint64_t left) const;

  FileWindow* window_;
  FileLayout* layout_;
  FaultLog* faults_;
  std::optional<End> end_;
  bool damaged_ = false;
  std::set<Opcode> strange_;  // kinds of other programs that were told of
};

}  // namespace penumbra::io::mcap
