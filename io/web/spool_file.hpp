// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>

#include <io/mcap/compression.hpp>

namespace penumbra::io {

/// The position of a content in a spool file.
struct SpoolPlace {
  std::uint64_t offset = 0;
  std::size_t stored = 0;  ///< bytes in the file
  std::size_t size = 0;    ///< bytes of the content
  bool is_packed = false;
};

/// A temporary file without a name. The system removes it when the program ends in any way.
class SpoolFile {
 public:
  /// Makes the file in TMPDIR, else in /var/tmp, which is on a disk. Throws InputError if it cannot
  /// be made.
  SpoolFile();
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  /// Adds bytes, compressed if `pack` is set. Use one thread at a time. Throws InputError if the
  /// disk is full.
  SpoolPlace append(std::span<const std::byte> bytes, bool pack);

  /// Reads a content. Any thread may call this. Throws std::runtime_error if the disk fails.
  [[nodiscard]] std::string read(const SpoolPlace& place) const;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;
  mcap::Compressor compressor_{mcap::Compression::zstd};
  std::vector<std::byte> packed_;
};

}  // namespace penumbra::io
