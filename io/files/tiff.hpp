// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

/// Reads the first image of a TIFF file of one integer of 16 or 32 bits or one float per pixel,
/// in strips. `scale`: metres per unit; default: millimetres for integers, metres for floats.
/// Returns a fault of the file, another kind of pixels or size, or that the build lacks libtiff.
[[nodiscard]] FileResult read_tiff_depth(const std::filesystem::path& file,
                                         std::optional<ImageSize> wanted,
                                         std::optional<double> scale, SharedDepth& depth);

}  // namespace penumbra::io
