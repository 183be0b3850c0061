// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include <png.h>

#include <penumbra/camera/camera.hpp>

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
constexpr std::size_t signature_bytes = 8;

/// What is wrong with an image.
struct PngFault {
  std::string text;
};

// Errors are thrown through libpng. It warns of what does not touch the pixels.
[[noreturn]] void on_error(png_structp, png_const_charp text) { throw PngFault{text}; }
void on_warning(png_structp, png_const_charp) {}

/// The state of libpng: `make` and `free` are its functions for files that are read or written.
template <auto make, auto free>
struct State {
  State() {
    if (info == nullptr) throw std::bad_alloc();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { free(&png, &info); }

  png_structp png = make(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning);
  png_infop info = png_create_info_struct(png);
};

void free_read_struct(png_structpp png, png_infopp info) {
  png_destroy_read_struct(png, info, nullptr);
}

bool has_signature(std::span<const std::byte> file) {
  return file.size() >= signature_bytes &&
         png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, signature_bytes) == 0;
}

void read_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* rest = static_cast<std::span<const std::byte>*>(png_get_io_ptr(png));
  if (count > rest->size()) png_error(png, "ends too early");
  std::memcpy(to, rest->data(), count);
  *rest = rest->subspan(count);
}

std::optional<std::string> size_fault(png_const_structp png, png_const_infop info,
                                      std::size_t file_bytes, std::optional<ImageSize> wanted) {
  const std::uint64_t width = png_get_image_width(png, info);
  const std::uint64_t height = png_get_image_height(png, info);
  const std::string pixels =
      "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (std::max(width, height) > Intrinsics::max_size)
    return pixels + "; at most " + std::to_string(Intrinsics::max_size) + " each are possible";
  const ImageSize size{static_cast<int>(width), static_cast<int>(height)};
  if (wanted && size != *wanted) return wrong_size(size, *wanted);
  if (png_get_rowbytes(png, info) * height > max_expansion * file_bytes)
    return pixels + ", more than a file of " + std::to_string(file_bytes) + " bytes can hold";
  return std::nullopt;
}

std::optional<std::string> grey_fault(png_const_structp png, png_infop info, int wanted_bits) {
  constexpr std::array names = {"grey",          "", "RGB", "palette", "grey with alpha", "",
                                "RGB with alpha"};
  const int color_type = png_get_color_type(png, info), bits = png_get_bit_depth(png, info);
  const bool transparent = png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  const bool is_grey = color_type == PNG_COLOR_TYPE_GRAY;
  const bool is_palette = color_type == PNG_COLOR_TYPE_PALETTE && bits == 8;  // of labels
  if ((is_grey || is_palette) && bits == wanted_bits && !transparent) return std::nullopt;
  return "is " + std::to_string(bits) + "-bit " + names.at(color_type) +
         (transparent ? " with transparency" : "") + "; expected " + std::to_string(wanted_bits) +
         "-bit grey";
}

/// Reads the pixels and the rest of the file. Rows have `stride` bytes each.
void read_rows(png_structp png, png_infop info, png_bytep rows, std::size_t stride, bool as_rgb) {
  if (as_rgb) {
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_strip_alpha(png);
    png_set_gray_to_rgb(png);
  } else if (png_get_bit_depth(png, info) == 16) {
    png_set_swap(png);
  }
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != stride) png_error(png, "rows of unexpected length");
  const png_uint_32 height = png_get_image_height(png, info);
  for (int pass = 0; pass < passes; ++pass)
    for (png_uint_32 v = 0; v < height; ++v) png_read_row(png, rows + v * stride, nullptr);
  png_read_end(png, nullptr);
}

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

constexpr Encoding colour_encoding{PNG_COLOR_TYPE_RGB, 8, PNG_FILTER_SUB};

// Replaces the content of `bytes` by a file. `name` is that of an error.
template <typename T>
void encode_image(ImageView<const T> image, const Encoding& encoding, std::vector<std::byte>& bytes,
                  const std::string& name) try {
  bytes.clear();
  State<png_create_write_struct, png_destroy_write_struct> state;
  const auto& [png, info] = state;
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
} catch (const PngFault& fault) {
  throw InputError(name + ": cannot be encoded: " + fault.text);
}

template <typename T>
void write_image(const std::filesystem::path& file, ImageView<const T> image,
                 const Encoding& encoding) {
  std::vector<std::byte> bytes;
  encode_image(image, encoding, bytes, file.string());
  write_file(file, bytes.data(), bytes.size());
}

}  // namespace

template <typename T>
std::optional<std::string> decode_png(std::span<const std::byte> bytes, Image<T>& image,
                                      std::optional<ImageSize> wanted) try {
  if constexpr (std::is_same_v<T, std::uint16_t>)
    if (decode_depth_png(bytes, image, wanted)) return std::nullopt;
  if (!has_signature(bytes))
    return "is no PNG; convert it to one (colour: 8-bit, depth: 16-bit grey, millimetres)";
  State<png_create_read_struct, free_read_struct> state;
  const auto& [png, info] = state;
  std::span<const std::byte> rest = bytes;
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_chunk_malloc_max(png, max_chunk_bytes);
  png_set_read_fn(png, &rest, read_bytes);
  png_read_info(png, info);

  constexpr bool as_rgb = std::is_same_v<T, Rgb8>;
  std::optional<std::string> fault;
  if (!as_rgb) fault = grey_fault(png, info, 8 * static_cast<int>(sizeof(T)));
  if (!fault) fault = size_fault(png, info, bytes.size(), wanted);
  if (fault) return fault;
  image.fit(static_cast<int>(png_get_image_width(png, info)),
            static_cast<int>(png_get_image_height(png, info)));
  read_rows(png, info, reinterpret_cast<png_bytep>(image.data()),
            static_cast<std::size_t>(image.width()) * sizeof(T), as_rgb);
  return std::nullopt;
} catch (const PngFault& fault) {
  return "is a damaged PNG: " + fault.text;
}

template <typename T>
FileResult read_png(const std::filesystem::path& file, Image<T>& image,
                    std::optional<ImageSize> wanted) {
  InputFile input;
  if (FileResult opened = input.open(file); !opened.ok()) return opened;
  if (input.size() > max_file_bytes) return FileResult::bad(file, "is no image: larger than 1 GB");
  std::vector<std::byte> bytes(signature_bytes);
  bytes.resize(input.read(bytes.data(), bytes.size()));
  if (has_signature(bytes)) {  // then the rest is read
    bytes.resize(std::max<std::size_t>(input.size(), signature_bytes));
    bytes.resize(signature_bytes +
                 input.read(&bytes[signature_bytes], bytes.size() - signature_bytes));
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
  encode_image(image, colour_encoding, bytes, "PNG");
}

}  // namespace penumbra::io
