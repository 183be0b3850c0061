// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <penumbra/base/image.hpp>

#include <io/files/disk_file.hpp>
#include <io/files/image_size.hpp>

namespace penumbra::io {

/// Reads the depth channel of an EXR file: its only one, or the only one called Z (or LAYER.Z), V
/// or Y. `scale`: metres per unit, default 1. Returns a fault of the file, another size than
/// wanted, or that the build lacks OpenEXR. Throws std::exception for damaged files.
[[nodiscard]] FileResult read_exr_depth(const std::filesystem::path& file,
                                        std::optional<ImageSize> wanted,
                                        std::optional<double> scale, SharedDepth& depth);

}  // namespace penumbra::io
