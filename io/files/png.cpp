// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include <png.h>

#include <penumbra/camera/intrinsics.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/png.hpp>
#include <io/files/png_depth.hpp>

namespace penumbra::io {
namespace {

static_assert(sizeof(Rgb8) == 3, "rows of Rgb8 are PNG's rows of 8-bit RGB");

// Deflate cannot make more than this many bytes of one (RFC 1951: 258 bytes from two bits).
constexpr std::uint64_t max_expansion = 1032;
constexpr std::uint64_t max_file_bytes = 1U << 30U;
constexpr png_alloc_size_t max_chunk_bytes = 1 << 20;  // of a chunk that is not pixels

// Runs `call`, which calls libpng, and returns whether it succeeded. libpng reports a fault by a
// jump to here: `call` must not own anything that needs a destructor.
template <typename F>
bool guarded(png_structp png, const F& call) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT: libpng's only way
  call();
  return true;
}

struct PngFault {
  std::array<char, 96> text{};
};

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  auto* fault = static_cast<PngFault*>(png_get_error_ptr(png));
  std::snprintf(fault->text.data(), fault->text.size(), "%s", text);
  png_longjmp(png, 1);
}

// libpng warns of what does not touch the pixels.
void on_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* rest = static_cast<std::span<const std::byte>*>(png_get_io_ptr(png));
  if (count > rest->size()) png_error(png, "ends too early");
  std::memcpy(to, rest->data(), count);
  *rest = rest->subspan(count);
}

class PngDecoder {
 public:
  explicit PngDecoder(std::span<const std::byte> file)
      : size_(file.size()),
        rest_(file),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &fault_, on_error, on_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_chunk_malloc_max(png_, max_chunk_bytes);
    png_set_read_fn(png_, &rest_, read_bytes);
  }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // Each returns what is wrong, or nothing.
  std::string read_header() {
    return guarded(png_, [this] { png_read_info(png_, info_); }) ? "" : damaged();
  }

  std::string check_size(std::optional<ImageSize> wanted) const {
    const std::uint64_t width = png_get_image_width(png_, info_);
    const std::uint64_t height = png_get_image_height(png_, info_);
    const std::string pixels =
        "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width > Intrinsics::max_size || height > Intrinsics::max_size)
      return pixels + "; at most " + std::to_string(Intrinsics::max_size) + " each are possible";
    if (wanted && size() != *wanted) return wrong_size(size(), *wanted);
    if (png_get_rowbytes(png_, info_) * height > max_expansion * size_)
      return pixels + ", more than a file of " + std::to_string(size_) + " bytes can hold";
    return {};
  }

  std::string check_grey(int bits) const {
    const int color_type = png_get_color_type(png_, info_);
    const bool transparent = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
    const bool is_grey = color_type == PNG_COLOR_TYPE_GRAY;
    const bool is_palette = color_type == PNG_COLOR_TYPE_PALETTE && bits == 8;  // of labels
    if ((is_grey || is_palette) && png_get_bit_depth(png_, info_) == bits && !transparent)
      return {};
    return "is " + std::to_string(png_get_bit_depth(png_, info_)) + "-bit " +
           color_name(color_type) + (transparent ? " with transparency" : "") + "; expected " +
           std::to_string(bits) + "-bit grey";
  }

  // Reads the rest of the file. Rows have `stride` bytes each.
  std::string read_rows(png_bytep rows, std::size_t stride, bool as_rgb) {
    const bool done = guarded(png_, [&] {
      if (as_rgb) {
        png_set_expand(png_);
        png_set_scale_16(png_);
        png_set_strip_alpha(png_);
        png_set_gray_to_rgb(png_);
      } else if (png_get_bit_depth(png_, info_) == 16) {
        png_set_swap(png_);
      }
      const int passes = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
      if (png_get_rowbytes(png_, info_) != stride) png_error(png_, "rows of unexpected length");
      const png_uint_32 height = png_get_image_height(png_, info_);
      for (int pass = 0; pass < passes; ++pass)
        for (png_uint_32 v = 0; v < height; ++v) png_read_row(png_, rows + v * stride, nullptr);
      png_read_end(png_, nullptr);
    });
    return done ? "" : damaged();
  }

  ImageSize size() const {
    return {static_cast<int>(png_get_image_width(png_, info_)),
            static_cast<int>(png_get_image_height(png_, info_))};
  }

 private:
  static std::string color_name(int color_type) {
    switch (color_type) {
      case PNG_COLOR_TYPE_GRAY:
        return "grey";
      case PNG_COLOR_TYPE_GRAY_ALPHA:
        return "grey with alpha";
      case PNG_COLOR_TYPE_PALETTE:
        return "palette";
      case PNG_COLOR_TYPE_RGB_ALPHA:
        return "RGB with alpha";
      default:
        return "RGB";
    }
  }

  std::string damaged() const {
    const std::string said = fault_.text.data();
    if (said == "Not a PNG file")  // libpng's words for another signature
      return "is no PNG; convert it to one (colour: 8-bit, depth: 16-bit grey, millimetres)";
    return "is a damaged PNG: " + said;
  }

  std::uint64_t size_;
  std::span<const std::byte> rest_;
  PngFault fault_;
  png_structp png_;
  png_infop info_;
};

void append_bytes(png_structp png, png_bytep from, std::size_t count) {
  auto* bytes = static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(from);
  bytes->insert(bytes->end(), first, first + count);
}

void flush_nothing(png_structp) {}

// How rows are stored. On flat label and link images any filter costs more than it saves; on
// photographs differences of neighbours halve the work of deflate.
struct Encoding {
  int color_type;
  int bits;
  int filter;
  std::span<const Rgb8> palette = {};
};

// Replaces the content of `bytes` by a file. Returns what is wrong, or nothing.
template <typename T>
std::string encode_image(ImageView<const T> image, const Encoding& encoding,
                         std::vector<std::byte>& bytes) {
  PngFault fault;
  bytes.clear();
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) {
    png_destroy_write_struct(&png, nullptr);
    throw std::bad_alloc();
  }
  const bool done = guarded(png, [&] {
    png_set_write_fn(png, &bytes, append_bytes, flush_nothing);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), encoding.bits, encoding.color_type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!encoding.palette.empty())
      png_set_PLTE(png, info, reinterpret_cast<png_const_colorp>(encoding.palette.data()),
                   static_cast<int>(encoding.palette.size()));
    png_set_compression_level(png, 1);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, encoding.filter);
    png_write_info(png, info);
    if (encoding.bits == 16) png_set_swap(png);
    for (int v = 0; v < image.height; ++v)
      png_write_row(png, reinterpret_cast<png_const_bytep>(image.row(v)));
    png_write_end(png, nullptr);
  });
  png_destroy_write_struct(&png, &info);
  return done ? std::string() : std::string("cannot be encoded: ") + fault.text.data();
}

constexpr Encoding colour_encoding{PNG_COLOR_TYPE_RGB, 8, PNG_FILTER_SUB};

template <typename T>
void write_image(const std::filesystem::path& file, ImageView<const T> image,
                 const Encoding& encoding) {
  std::vector<std::byte> bytes;
  if (const std::string fault = encode_image(image, encoding, bytes); !fault.empty())
    throw InputError(file.string() + ": " + fault);
  write_file(file, bytes.data(), bytes.size());
}

}  // namespace

template <typename T>
std::optional<std::string> decode_png(std::span<const std::byte> bytes, Image<T>& image,
                                      std::optional<ImageSize> wanted) {
  if constexpr (std::is_same_v<T, std::uint16_t>)
    if (decode_depth_png(bytes, image, wanted)) return std::nullopt;
  constexpr bool as_rgb = std::is_same_v<T, Rgb8>;
  PngDecoder decoder(bytes);
  std::string fault = decoder.read_header();
  if (fault.empty() && !as_rgb) fault = decoder.check_grey(8 * static_cast<int>(sizeof(T)));
  if (fault.empty()) fault = decoder.check_size(wanted);
  if (!fault.empty()) return fault;

  const ImageSize size = decoder.size();
  image.fit(size.width, size.height);
  fault = decoder.read_rows(reinterpret_cast<png_bytep>(image.data()),
                            static_cast<std::size_t>(size.width) * sizeof(T), as_rgb);
  return fault.empty() ? std::nullopt : std::optional(fault);
}

template <typename T>
FileResult read_png(const std::filesystem::path& file, Image<T>& image,
                    std::optional<ImageSize> wanted) {
  InputFile input;
  if (FileResult opened = input.open(file); !opened.ok()) return opened;
  if (input.size() > max_file_bytes) return FileResult::bad(file, "is no image: larger than 1 GB");
  constexpr std::size_t signature = 8;  // the rest is read if it is that of a PNG file
  std::vector<std::byte> bytes(signature);
  bytes.resize(input.read(bytes.data(), signature));
  if (bytes.size() == signature &&
      png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, signature) == 0) {
    bytes.resize(std::max<std::size_t>(input.size(), signature));
    bytes.resize(signature + input.read(&bytes[signature], bytes.size() - signature));
  }
  const auto fault = decode_png(bytes, image, wanted);
  return fault ? FileResult::bad(file, *fault) : FileResult{};
}

template std::optional<std::string> decode_png(std::span<const std::byte>, Image<std::uint16_t>&,
                                               std::optional<ImageSize>);
template std::optional<std::string> decode_png(std::span<const std::byte>, Image<Rgb8>&,
                                               std::optional<ImageSize>);
template FileResult read_png(const std::filesystem::path&, Image<std::uint8_t>&,
                             std::optional<ImageSize>);
template FileResult read_png(const std::filesystem::path&, Image<std::uint16_t>&,
                             std::optional<ImageSize>);
template FileResult read_png(const std::filesystem::path&, Image<Rgb8>&, std::optional<ImageSize>);

void write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> image) {
  write_image(file, image, {PNG_COLOR_TYPE_GRAY, 8, PNG_FILTER_NONE});
}

void write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> image,
               std::span<const Rgb8> palette) {
  write_image(file, image, {PNG_COLOR_TYPE_PALETTE, 8, PNG_FILTER_NONE, palette});
}

void write_png(const std::filesystem::path& file, ImageView<const std::uint16_t> image) {
  write_image(file, image, {PNG_COLOR_TYPE_GRAY, 16, PNG_FILTER_NONE});
}

void write_png(const std::filesystem::path& file, ImageView<const Rgb8> image) {
  write_image(file, image, colour_encoding);
}

void encode_png(ImageView<const Rgb8> image, std::vector<std::byte>& bytes) {
  if (const std::string fault = encode_image(image, colour_encoding, bytes); !fault.empty())
    throw InputError("PNG: " + fault);
}

}  // namespace penumbra::io
