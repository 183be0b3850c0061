// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

/// Reads a depth image, whose format its first bytes say: PNG or TIFF of 16-bit grey, NumPy
/// of integers (millimetres), TIFF, EXR or NumPy of floating-point numbers (metres). `scale`:
/// metres per unit instead of these. Returns a fault of the file, or another size than wanted.
/// Never throws.
[[nodiscard]] FileResult read_depth(const std::filesystem::path& file,
                                    std::optional<ImageSize> wanted, std::optional<double> scale,
                                    SharedDepth& depth);

/// Reads a colour image, PNG or JPEG.
[[nodiscard]] FileResult read_color(const std::filesystem::path& file,
                                    std::optional<ImageSize> wanted, Image<Rgb8>& color);

}  // namespace penumbra::io
