// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <io/files/depth_pixels.hpp>
#include <io/files/exr.hpp>
#include <io/files/image_file.hpp>
#include <io/files/jpeg.hpp>
#include <io/files/npy.hpp>
#include <io/files/png.hpp>
#include <io/files/tiff.hpp>

namespace penumbra::io {
namespace {

using namespace std::string_view_literals;

/// Returns a file's first bytes.
FileResult read_start(const std::filesystem::path& file, std::string& start) {
  InputFile input;
  FileResult opened = input.open(file);
  start.resize(8);
  if (opened.ok()) start.resize(input.read(start.data(), start.size()));
  return opened;
}

FileResult read_any_depth(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                          std::optional<double> scale, SharedDepth& depth) {
  std::string start;
  if (FileResult opened = read_start(file, start); !opened.ok()) return opened;
  if (start.starts_with("\x93NUMPY")) return read_npy_depth(file, wanted, scale, depth);
  if (start.starts_with("II*\0"sv) || start.starts_with("MM\0*"sv) ||
      start.starts_with("II+\0"sv) || start.starts_with("MM\0+"sv))
    return read_tiff_depth(file, wanted, scale, depth);
  if (start.starts_with("\x76\x2f\x31\x01")) return read_exr_depth(file, wanted, scale, depth);
  if (start.starts_with("\xff\xd8\xff"))
    return FileResult::bad(file, "is a JPEG, which has no exact depths; give 16-bit PNG or TIFF");
  if (!start.starts_with("\x89PNG"))
    return FileResult::bad(file, "is no depth image; PNG, TIFF, EXR and NumPy files are read");
  Image<std::uint16_t> pixels;
  FileResult result = read_png(file, pixels, wanted);
  if (result.ok()) depth = shared_depth_of(std::move(pixels), scale);
  return result;
}

}  // namespace

FileResult read_depth(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                      std::optional<double> scale, SharedDepth& depth) {
  try {
    return read_any_depth(file, wanted, scale, depth);
  } catch (const std::exception& error) {  // of libraries
    return FileResult::bad(file, error.what());
  }
}

FileResult read_color(const std::filesystem::path& file, std::optional<ImageSize> wanted,
                      Image<Rgb8>& color) {
  std::string start;
  if (FileResult opened = read_start(file, start); !opened.ok()) return opened;
  if (!start.starts_with("\xff\xd8\xff")) return read_png(file, color, wanted);
  InputFile input;
  if (FileResult opened = input.open(file); !opened.ok()) return opened;
  constexpr std::uint64_t most_bytes = 1U << 30U;
  if (input.size() > most_bytes) return FileResult::bad(file, "is no image: larger than 1 GB");
  std::vector<std::byte> bytes(input.size());
  bytes.resize(input.read(bytes.data(), bytes.size()));
  if (const auto fault = decode_jpeg(bytes, color)) return FileResult::bad(file, *fault);
  const ImageSize size{color.width(), color.height()};
  if (wanted && size != *wanted) return FileResult::bad(file, wrong_size(size, *wanted));
  return {};
}

}  // namespace penumbra::io
