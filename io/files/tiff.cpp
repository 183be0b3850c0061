// SPDX-License-Identifier: Apache-2.0
#include <io/files/tiff.hpp>

#if PENUMBRA_WITH_TIFF

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <tiffio.h>

#include <io/files/depth_pixels.hpp>

namespace penumbra::io {
namespace {

struct TiffTags {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 0, channels = 0, format = 0;
};

template <typename T>
FileResult read_tiff_rows(TIFF* tiff, const std::filesystem::path& file, const TiffTags& tags,
                          std::optional<double> scale, SharedDepth& depth) {
  Image<T> pixels(static_cast<int>(tags.width), static_cast<int>(tags.height));
  for (std::uint32_t v = 0; v < tags.height; ++v)
    if (TIFFReadScanline(tiff, pixels.view().row(static_cast<int>(v)), v) < 0)
      return FileResult::bad(file, "is a damaged TIFF");
  depth = shared_depth_of(std::move(pixels), scale);
  return {};
}

}  // namespace

FileResult read_tiff_depth(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                           std::optional<double> scale, SharedDepth& depth) {
  // libtiff prints messages otherwise.
  [[maybe_unused]] static const bool is_silent =
      (TIFFSetErrorHandler(nullptr), TIFFSetWarningHandler(nullptr), true);
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(file.c_str(), "rm"), TIFFClose);
  if (!tiff) return FileResult::bad(file, "is a damaged TIFF");
  TiffTags tags;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &tags.width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &tags.height);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_BITSPERSAMPLE, &tags.bits);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &tags.channels);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &tags.format);
  if (auto fault = check_image_size(tags.width, tags.height)) return FileResult::bad(file, *fault);
  const ImageSize size{static_cast<int>(tags.width), static_cast<int>(tags.height)};
  if (wanted && size != *wanted) return FileResult::bad(file, wrong_size(size, *wanted));
  if (auto fault = check_expansion(size, std::filesystem::file_size(file)))
    return FileResult::bad(file, *fault);
  if (TIFFIsTiled(tiff.get()) != 0) return FileResult::bad(file, "is in tiles; expected strips");
  if (tags.channels == 1) {
    const auto read_as = [&]<typename T>(T) {
      return read_tiff_rows<T>(tiff.get(), file, tags, scale, depth);
    };
    const std::pair<int, int> kind(tags.format, tags.bits);
    if (kind == std::pair(SAMPLEFORMAT_UINT, 16)) return read_as(std::uint16_t{});
    if (kind == std::pair(SAMPLEFORMAT_UINT, 32)) return read_as(std::uint32_t{});
    if (kind == std::pair(SAMPLEFORMAT_INT, 32)) return read_as(std::int32_t{});
    if (kind == std::pair(SAMPLEFORMAT_IEEEFP, 32)) return read_as(float{});
    if (kind == std::pair(SAMPLEFORMAT_IEEEFP, 64)) return read_as(double{});
  }
  return FileResult::bad(file, "has " + std::to_string(tags.channels) + " x " +
                                   std::to_string(tags.bits) +
                                   " bits per pixel; expected one integer of 16 or 32 bits "
                                   "(millimetres) or one float (metres)");
}

}  // namespace penumbra::io

#else

namespace penumbra::io {

FileResult read_tiff_depth(const std::filesystem::path& file, std::optional<ImageSize>,
                           std::optional<double>, SharedDepth&) {
  return FileResult::bad(file, "is a TIFF file, which this build does not read (it lacks libtiff)");
}

}  // namespace penumbra::io

#endif
