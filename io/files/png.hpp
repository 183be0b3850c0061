// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/file_result.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb8&) const = default;
};

/// Reads a PNG file into `image`, whose buffer is kept where the size stays. Any fault of the file
/// (missing, truncated at any byte, damaged, another pixel format or, where given, another size) is
/// answered, never thrown; `image` is then unspecified. Allocates no more than the file can hold.
///
/// uint16: 16-bit grey only; uint8: 8-bit grey, or the values of an 8-bit palette. Depths and
/// labels must not be converted, so other depths, colour, alpha and transparency are faults.
[[nodiscard]] FileResult read_png(const std::filesystem::path& file, Image<std::uint16_t>& image,
                                  std::optional<ImageSize> wanted = {});
[[nodiscard]] FileResult read_png(const std::filesystem::path& file, Image<std::uint8_t>& image,
                                  std::optional<ImageSize> wanted = {});

/// Colour: every pixel format is brought to 8-bit RGB; alpha is dropped.
[[nodiscard]] FileResult read_png(const std::filesystem::path& file, Image<Rgb8>& image,
                                  std::optional<ImageSize> wanted = {});

/// Writes 8-bit grey, 16-bit grey or 8-bit RGB, quickly rather than small. The image must not be
/// empty. Throws InputError that names a file that cannot be written.
void write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> image);
void write_png(const std::filesystem::path& file, ImageView<const std::uint16_t> image);
/// The same with colours for the values, each of which is an index into `palette`.
void write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> image,
               std::span<const Rgb8> palette);
void write_png(const std::filesystem::path& file, ImageView<const Rgb8> image);

/// The same of files in memory. Answers what is wrong, or nothing.
[[nodiscard]] std::optional<std::string> decode_png(std::span<const std::byte> bytes,
                                                    Image<std::uint16_t>& image,
                                                    std::optional<ImageSize> wanted = {});
[[nodiscard]] std::optional<std::string> decode_png(std::span<const std::byte> bytes,
                                                    Image<Rgb8>& image,
                                                    std::optional<ImageSize> wanted = {});

/// Puts the file in place of what `bytes` holds.
void encode_png(ImageView<const Rgb8> image, std::vector<std::byte>& bytes);

}  // namespace penumbra::io
