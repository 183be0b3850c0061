// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

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
