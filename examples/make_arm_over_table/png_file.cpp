// SPDX-License-Identifier: Apache-2.0
#include "png_file.hpp"

#include "text.hpp"

#include <stdexcept>
#include <string>

#include <png.h>

namespace example {
namespace {

[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(std::string("libpng: ") + message);
}

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(data), size);
}

void write(const std::filesystem::path& file, int width, int height, int bits, int colour_type,
           std::vector<std::uint8_t>& bytes) {
  std::string encoded;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &encoded, append, nullptr);
  png_set_compression_level(png, 9);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t row = bytes.size() / static_cast<std::size_t>(height);
  for (int v = 0; v < height; ++v)
    png_write_row(png, bytes.data() + row * static_cast<std::size_t>(v));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  write_file(file, encoded);
}

}  // namespace

void write_grey8(const std::filesystem::path& file, int width, int height,
                 std::vector<std::uint8_t> pixels) {
  write(file, width, height, 8, PNG_COLOR_TYPE_GRAY, pixels);
}

void write_grey16(const std::filesystem::path& file, int width, int height,
                  const std::vector<std::uint16_t>& pixels) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * pixels.size());
  for (const std::uint16_t p : pixels) {
    bytes.push_back(static_cast<std::uint8_t>(p >> 8));
    bytes.push_back(static_cast<std::uint8_t>(p & 0xFF));
  }
  write(file, width, height, 16, PNG_COLOR_TYPE_GRAY, bytes);
}

void write_rgb8(const std::filesystem::path& file, int width, int height,
                std::vector<std::uint8_t> pixels) {
  write(file, width, height, 8, PNG_COLOR_TYPE_RGB, pixels);
}

}  // namespace example
