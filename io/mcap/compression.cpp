// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <new>
#include <stdexcept>

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <io/files/disk_file.hpp>
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

// Returns a context that is freed with its last owner.
template <typename Context>
std::shared_ptr<void> checked(Context* context, std::size_t (*free)(Context*)) {
  if (context == nullptr) throw std::bad_alloc();
  return std::shared_ptr<Context>(context, free);
}

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
    if (!zstd_) zstd_ = checked(ZSTD_createDCtx(), ZSTD_freeDCtx);
    return zstd_decompress(static_cast<ZSTD_DCtx*>(zstd_.get()), from, size, to);
  }
  if (compression == to_string(Compression::lz4)) {
    LZ4F_dctx* context = nullptr;
    if (!lz4_ && LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0)
      lz4_ = checked(context, LZ4F_freeDecompressionContext);
    if (!lz4_) throw std::bad_alloc();
    return lz4_decompress(static_cast<LZ4F_dctx*>(lz4_.get()), from, size, to);
  }
  return "is compressed as '" + printable(compression) + "'; lz4, zstd and none are read";
}

std::string decompress_zstd(const std::filesystem::path& from, const std::filesystem::path& to) {
  constexpr std::uint64_t most_file_ratio = 1000;  // of blank images; the disk has to hold it
  InputFile input;
  input.open(from).require();
  OutputFile output(to);
  const auto context = checked(ZSTD_createDCtx(), ZSTD_freeDCtx);
  std::vector<std::byte> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::uint64_t left = unbacked_bytes + most_file_ratio * input.size();
  std::size_t result = 1;  // 0 at the end of a frame
  while (const std::size_t read = input.read(packed.data(), packed.size())) {
    ZSTD_inBuffer in{packed.data(), read, 0};
    ZSTD_outBuffer out{plain.data(), plain.size(), plain.size()};
    while (in.pos < in.size || out.pos == out.size) {
      out.pos = 0;
      result = ZSTD_decompressStream(static_cast<ZSTD_DCtx*>(context.get()), &out, &in);
      if (ZSTD_isError(result) != 0) return undone("zstd", ZSTD_getErrorName(result));
      if (out.pos > left) return undone("zstd", "it becomes more than 1000 times as large");
      left -= out.pos;
      output.write(plain.data(), out.pos);
      if (result == 0 && in.pos == in.size) break;
    }
  }
  output.close();
  return result == 0 ? "" : undone("zstd", "it is truncated");
}

void Compressor::compress(std::span<const std::byte> from, std::vector<std::byte>& to) {
  std::size_t result = 0;
  bool failed = true;
  if (compression_ == Compression::lz4) {
    to.resize(LZ4F_compressFrameBound(from.size(), nullptr));
    result = LZ4F_compressFrame(to.data(), to.size(), from.data(), from.size(), nullptr);
    failed = LZ4F_isError(result) != 0;
  } else if (compression_ == Compression::zstd) {
    if (!zstd_) zstd_ = checked(ZSTD_createCCtx(), ZSTD_freeCCtx);
    to.resize(ZSTD_compressBound(from.size()));
    result = ZSTD_compressCCtx(static_cast<ZSTD_CCtx*>(zstd_.get()), to.data(), to.size(),
                               from.data(), from.size(), zstd_level);
    failed = ZSTD_isError(result) != 0;
  }
  if (failed) throw std::runtime_error("a chunk could not be compressed");  // there is room
  to.resize(result);
}

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
  if (bytes.empty()) return before;
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace penumbra::io::mcap
