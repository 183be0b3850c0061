// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <io/mcap/byte_buffer.hpp>

namespace penumbra::io::mcap {

enum class Compression { none, lz4, zstd };

/// As chunks spell it: "", "lz4", "zstd".
[[nodiscard]] std::string_view to_string(Compression compression);

/// Most bytes that `compressed` ones may become. Chunks of blank images shrink a thousandfold and
/// more, but have not more than 64 MB; beyond that, more than 64-fold is a bomb's.
[[nodiscard]] std::uint64_t most_decompressed(std::uint64_t compressed);

class Decompressor {
 public:
  Decompressor();
  ~Decompressor();
  Decompressor(Decompressor&&) noexcept;
  Decompressor& operator=(Decompressor&&) noexcept;

  /// Decompresses LZ4 or Zstandard frames into `to`, which must become `size` bytes. Memory grows
  /// with what really comes out, whatever `size` claims. Answers what is wrong, or nothing.
  [[nodiscard]] std::string decompress(std::string_view compression,
                                       std::span<const std::byte> from, std::uint64_t size,
                                       ByteBuffer& to);

 private:
  struct Contexts;
  std::unique_ptr<Contexts> contexts_;
};

class Compressor {
 public:
  explicit Compressor(Compression compression);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  /// The same bytes for the same input, always. Must not be called for Compression::none.
  void compress(std::span<const std::byte> from, ByteBuffer& to);

 private:
  struct Contexts;
  Compression compression_;
  std::unique_ptr<Contexts> contexts_;
};

}  // namespace penumbra::io::mcap
