// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

/// What stands before the samples of a NumPy file.
struct NpyHeader {
  std::string type;  ///< "<f4"
  bool is_fortran = false;
  std::vector<std::uint64_t> shape;
  std::size_t size = 0;  ///< bytes before the samples
};

/// Reads the header at the beginning of a file of a plain array (format versions 1 to 3). Returns
/// what is wrong, or nothing.
[[nodiscard]] std::string parse_npy_header(std::span<const std::byte> file, NpyHeader& header);

/// Returns the header of samples in C order.
[[nodiscard]] std::string npy_header(std::string_view type, std::span<const std::uint64_t> shape);

/// Reads a NumPy file of H x W little-endian float32 in C order (format versions 1 to 3). Reuses
/// the buffer of `image` if the size stays the same. Returns a fault of the file, or another
/// element type, order, number of dimensions or wanted size; `image` is then unspecified. Never
/// throws.
[[nodiscard]] FileResult read_npy(const std::filesystem::path& file, Image<float>& image,
                                  std::optional<ImageSize> wanted = {});

/// Reads a NumPy file of H x W or H x W x 1 float32, float64 or integers of 16 to 64 bits.
/// `scale`: metres per unit; default: millimetres for integers, metres for floating-point numbers.
[[nodiscard]] FileResult read_npy_depth(const std::filesystem::path& file,
                                        std::optional<ImageSize> wanted,
                                        std::optional<double> scale, SharedDepth& depth);

/// Writes H x W float32. The image must not be empty. Throws InputError that names a file that
/// cannot be written.
void write_npy(const std::filesystem::path& file, ImageView<const float> image);

}  // namespace penumbra::io
