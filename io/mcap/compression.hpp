// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::io::mcap {

enum class Compression { none, lz4, zstd };

/// Returns the name in chunks: "", "lz4", "zstd".
[[nodiscard]] std::string_view to_string(Compression compression);

/// Returns the largest size that `compressed` bytes may decompress to. Chunks of blank images
/// shrink a thousandfold and more, but have at most 64 MB. Beyond 64 MB, a ratio over 64 is treated
/// as a decompression bomb.
[[nodiscard]] std::uint64_t most_decompressed(std::uint64_t compressed);

class Decompressor {
 public:
  /// Decompresses LZ4 or Zstandard frames into `to`, which must become `size` bytes. Memory grows
  /// with the actual output, whatever `size` claims. Returns what is wrong, or an empty text.
  [[nodiscard]] std::string decompress(std::string_view compression,
                                       std::span<const std::byte> from, std::uint64_t size,
                                       std::vector<std::byte>& to);

 private:
  std::shared_ptr<void> lz4_, zstd_;  // contexts, made at the first use
};

/// Decompresses a file of Zstandard frames. Returns what is wrong, or an empty text; what comes
/// before that is written. Throws InputError for a file that cannot be read or written.
[[nodiscard]] std::string decompress_zstd(const std::filesystem::path& from,
                                          const std::filesystem::path& to);

class Compressor {
 public:
  explicit Compressor(Compression compression) : compression_(compression) {}

  /// Compresses bytes. The same input always gives the same output. Do not call it for
  /// Compression::none.
  void compress(std::span<const std::byte> from, std::vector<std::byte>& to);

 private:
  Compression compression_;
  std::shared_ptr<void> zstd_;  // context, made at the first use
};

/// Returns zlib's CRC-32 of bytes that follow those with the CRC `before`.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace penumbra::io::mcap
