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

/// Where something stands in a spool file.
struct SpoolPlace {
  std::uint64_t offset = 0;
  std::size_t stored = 0;  ///< bytes in the file
  std::size_t size = 0;    ///< bytes of the content
  bool is_packed = false;
};

/// A temporary file without a name: the system takes it away with the program, however that ends.
class SpoolFile {
 public:
  /// In TMPDIR, else in /var/tmp, which is on a disk. Throws InputError where it cannot be made.
  SpoolFile();
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  /// Adds bytes, compressed where `pack` says so. By one thread at a time. Throws InputError where
  /// the disk is full.
  SpoolPlace append(std::span<const std::byte> bytes, bool pack);

  /// By any thread. Throws std::runtime_error where the disk fails.
  [[nodiscard]] std::string read(const SpoolPlace& place) const;

  [[nodiscard]] std::uint64_t size() const { return end_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;
  mcap::Compressor compressor_{mcap::Compression::zstd};
  mcap::ByteBuffer packed_;
};

}  // namespace penumbra::io
