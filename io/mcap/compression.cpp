// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <new>
#include <stdexcept>

#include <lz4frame.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <io/files/printable.hpp>
#include <io/mcap/compression.hpp>
#include <io/mcap/records.hpp>

namespace penumbra::io::mcap {
namespace {

constexpr std::uint64_t unbacked_bytes = std::uint64_t{64} << 20;  // allowed for any input
constexpr std::uint64_t most_ratio = 64;                           // limit above that

// The room of the first attempt in proportion to the input: ordinary chunks shrink less.
constexpr std::uint64_t first_bytes = std::uint64_t{64} << 10;
constexpr std::uint64_t first_ratio = 16;
constexpr std::uint64_t growth = 4;

// LZ4 decodes blocks of this size directly into a buffer with room for a whole one.
constexpr std::size_t lz4_block = std::size_t{64} << 10;

// The fastest level, because recorders must keep up with cameras.
constexpr int zstd_level = 1;

std::uint64_t first_room(std::uint64_t compressed, std::uint64_t size) {
  return std::min(size, first_bytes + first_ratio * compressed);
}

void delete_lz4_reader(LZ4F_dctx* context) { LZ4F_freeDecompressionContext(context); }
void delete_zstd_reader(ZSTD_DCtx* context) { ZSTD_freeDCtx(context); }
void delete_zstd_writer(ZSTD_CCtx* context) { ZSTD_freeCCtx(context); }

std::string of_other_size(std::uint64_t size, std::string_view found) {
  return "decompresses to " + std::string(found) + " than the " + std::to_string(size) +
         " bytes that it claims";
}

std::string undone(std::string_view codec, std::string_view reason) {
  return "cannot be decompressed as " + std::string(codec) + ": " + std::string(reason);
}

// Zstandard needs its window in one piece, and a frame may claim a window of any size. So a whole
// frame is decompressed at once, and the result itself is the window.
std::string zstd_decompress(ZSTD_DCtx* context, std::span<const std::byte> from, std::uint64_t size,
                            std::vector<std::byte>& to) {
  for (std::uint64_t room = first_room(from.size(), size);; room = std::min(size, growth * room)) {
    to.clear();
    to.resize(room);
    const std::size_t result =
        ZSTD_decompressDCtx(context, to.data(), room, from.data(), from.size());
    if (ZSTD_isError(result) == 0) {
      to.resize(result);
      return result == size ? "" : of_other_size(size, "fewer");
    }
    if (ZSTD_getErrorCode(result) != ZSTD_error_dstSize_tooSmall)
      return undone("zstd", ZSTD_getErrorName(result));
    if (room == size) return of_other_size(size, "more");
  }
}

std::string lz4_decompress(LZ4F_dctx* context, std::span<const std::byte> from, std::uint64_t size,
                           std::vector<std::byte>& to) {
  LZ4F_resetDecompressionContext(context);
  to.clear();
  to.resize(first_room(from.size(), size) + lz4_block);
  std::uint64_t done = 0;
  bool in_frame = true;
  while (in_frame || !from.empty()) {
    if (done > size) return of_other_size(size, "more");
    if (to.size() < done + lz4_block) to.resize(std::min(size, growth * done) + lz4_block);
    std::size_t taken = from.size();
    std::size_t given = to.size() - done;
    const std::size_t result =
        LZ4F_decompress(context, to.data() + done, &given, from.data(), &taken, nullptr);
    if (LZ4F_isError(result) != 0) return undone("lz4", LZ4F_getErrorName(result));
    if (taken == 0 && given == 0 && in_frame) return undone("lz4", "its frame has no end");
    done += given;
    from = from.subspan(taken);
    in_frame = result != 0;
  }
  to.resize(done);
  if (to.size() == size) return {};
  return of_other_size(size, to.size() < size ? "fewer" : "more");
}

}  // namespace

std::string_view to_string(Compression compression) {
  switch (compression) {
    case Compression::lz4:
      return "lz4";
    case Compression::zstd:
      return "zstd";
    case Compression::none:
      break;
  }
  return "";
}

std::uint64_t most_decompressed(std::uint64_t compressed) {
  return std::clamp(most_ratio * compressed, unbacked_bytes, max_record_bytes);
}

struct Decompressor::Contexts {
  std::unique_ptr<LZ4F_dctx, void (*)(LZ4F_dctx*)> lz4{nullptr, delete_lz4_reader};
  std::unique_ptr<ZSTD_DCtx, void (*)(ZSTD_DCtx*)> zstd{nullptr, delete_zstd_reader};
};

Decompressor::Decompressor() : contexts_(std::make_unique<Contexts>()) {}
Decompressor::~Decompressor() = default;
Decompressor::Decompressor(Decompressor&&) noexcept = default;
Decompressor& Decompressor::operator=(Decompressor&&) noexcept = default;

std::string Decompressor::decompress(std::string_view compression, std::span<const std::byte> from,
                                     std::uint64_t size, std::vector<std::byte>& to) {
  if (size > most_decompressed(from.size()))
    return "claims to decompress from " + std::to_string(from.size()) + " to " +
           std::to_string(size) + " bytes";
  if (from.empty() && size == 0) {
    to.resize(0);
    return {};
  }
  if (compression == to_string(Compression::zstd)) {
    if (!contexts_->zstd) contexts_->zstd.reset(ZSTD_createDCtx());
    if (!contexts_->zstd) throw std::bad_alloc();
    return zstd_decompress(contexts_->zstd.get(), from, size, to);
  }
  if (compression == to_string(Compression::lz4)) {
    if (!contexts_->lz4) {
      LZ4F_dctx* created = nullptr;
      if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)) != 0)
        throw std::bad_alloc();
      contexts_->lz4.reset(created);
    }
    return lz4_decompress(contexts_->lz4.get(), from, size, to);
  }
  return "is compressed as '" + printable(compression) + "'; lz4, zstd and none are read";
}

struct Compressor::Contexts {
  std::unique_ptr<ZSTD_CCtx, void (*)(ZSTD_CCtx*)> zstd{nullptr, delete_zstd_writer};
};

Compressor::Compressor(Compression compression)
    : compression_(compression), contexts_(std::make_unique<Contexts>()) {
  if (compression != Compression::zstd) return;
  contexts_->zstd.reset(ZSTD_createCCtx());
  if (!contexts_->zstd) throw std::bad_alloc();
}

Compressor::~Compressor() = default;

void Compressor::compress(std::span<const std::byte> from, std::vector<std::byte>& to) {
  std::size_t result = 0;
  bool failed = true;
  if (compression_ == Compression::lz4) {
    to.resize(LZ4F_compressFrameBound(from.size(), nullptr));
    result = LZ4F_compressFrame(to.data(), to.size(), from.data(), from.size(), nullptr);
    failed = LZ4F_isError(result) != 0;
  } else if (compression_ == Compression::zstd) {
    to.resize(ZSTD_compressBound(from.size()));
    result = ZSTD_compressCCtx(contexts_->zstd.get(), to.data(), to.size(), from.data(),
                               from.size(), zstd_level);
    failed = ZSTD_isError(result) != 0;
  }
  if (failed) throw std::runtime_error("a chunk could not be compressed");  // there is room
  to.resize(result);
}

}  // namespace penumbra::io::mcap
