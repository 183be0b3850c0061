// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <io/files/disk_file.hpp>

namespace penumbra::io::mcap {

/// A part of a file in memory that moves with the accesses. Files are read, not mapped, so that a
/// file that is truncated meanwhile ends the reading and not the program.
class FileWindow {
 public:
  /// The file must outlive this.
  explicit FileWindow(const InputFile& file) : file_(&file) {}

  [[nodiscard]] std::uint64_t file_size() const { return file_->size(); }

  /// Returns `count` bytes from `offset`, fewer at the end of the file; valid until the next call.
  [[nodiscard]] std::span<const std::byte> view(std::uint64_t offset, std::size_t count);

 private:
  const InputFile* file_;
  std::uint64_t start_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace penumbra::io::mcap
