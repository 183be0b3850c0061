// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include <penumbra/base/image.hpp>
#include <penumbra/pipeline/without_robot.hpp>

#include <io/files/png.hpp>

namespace penumbra::io {

/// Writes points as binary PCD (x y z, and rgb where there is colour) and binary little-endian PLY
/// (x y z, and red green blue). `color`: of the image that the points' pixels are of; empty: none.
/// Throw InputError that names a file that cannot be written.
void write_pcd(const std::filesystem::path& file, const PointCloud& cloud,
               ImageView<const Rgb8> color);
void write_ply(const std::filesystem::path& file, const PointCloud& cloud,
               ImageView<const Rgb8> color);

}  // namespace penumbra::io
