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

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

/// Reads a PNG file. Reuses the buffer of `image` if the size stays the same. Returns a fault of
/// the file (missing, truncated, damaged, another pixel format, another size than wanted); `image`
/// is then unspecified. Allocates no more than the file can hold.
///
/// T: uint16 for 16-bit grey, uint8 for 8-bit grey or the indices of an 8-bit palette. Depths and
/// labels must not be converted, so other depths, colour, alpha and transparency are faults. Rgb8
/// for any pixel format, converted to 8-bit RGB; alpha is dropped.
template <typename T>
[[nodiscard]] FileResult read_png(const std::filesystem::path& file, Image<T>& image,
                                  std::optional<ImageSize> wanted = {});

/// The same for a file in memory. Returns what is wrong, or nothing.
template <typename T>
[[nodiscard]] std::optional<std::string> decode_png(std::span<const std::byte> bytes,
                                                    Image<T>& image,
                                                    std::optional<ImageSize> wanted = {});

/// Writes 8-bit grey, 16-bit grey or 8-bit RGB, fast rather than small. The image must not be
/// empty. Throws InputError that names the file if it cannot be written.
void write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> image);
void write_png(const std::filesystem::path& file, ImageView<const std::uint16_t> image);
/// Writes indices into `palette`.
void write_png(const std::filesystem::path& file, ImageView<const std::uint8_t> image,
               std::span<const Rgb8> palette);
void write_png(const std::filesystem::path& file, ImageView<const Rgb8> image);

/// Replaces the content of `bytes` by a PNG file.
void encode_png(ImageView<const Rgb8> image, std::vector<std::byte>& bytes);

}  // namespace penumbra::io
