// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <io/ros/messages.hpp>

namespace penumbra::io {

/// The limit of points of a cloud, in files and messages.
inline constexpr std::uint64_t most_cloud_points = 16'000'000;

/// A point cloud that owns its points: little-endian, without gaps between rows.
struct StoredCloud {
  StoredCloud() = default;
  StoredCloud(StoredCloud&&) noexcept = default;  // the points stay where they are
  StoredCloud& operator=(StoredCloud&&) noexcept = default;
  StoredCloud(const StoredCloud&) = delete;
  StoredCloud& operator=(const StoredCloud&) = delete;
  ~StoredCloud() = default;

  PointCloud2Message cloud;     ///< its data are those below
  std::vector<std::byte> data;  ///< if you replace it, set cloud.data
};

/// Returns whether the extension, in lower or upper case, names a format that is read and written.
[[nodiscard]] bool is_cloud_file(const std::filesystem::path& file);

/// Reads a point cloud of any fields; header and is_dense stay at their defaults. Throws InputError
/// that names the file and the fault. Allocates no more than the points of the file need, a few
/// times its size (compressed files: what they decompress to).
///
/// - .pcd: ascii, binary and binary_compressed. Padding is a field "_". VIEWPOINT is dropped.
///   64-bit integers, here and in .ply, are fields of the types 9 and 10, which ROS does not have.
/// - .ply: ascii and binary. The scalar properties of the element vertex; other elements are
///   skipped.
/// - .npy: N x C float32 or float64 with the fields x, y, z, f3, f4 and so on.
/// - .bin: float32: KITTI's x, y, z, intensity; nuScenes' with ring, too; or 3 or 6 numbers a
/// point.
///   Intensity and ring are never negative. Throws if the size and the values fit several of these.
[[nodiscard]] StoredCloud read_cloud(const std::filesystem::path& file);

/// Writes a point cloud in the format that the extension names. Throws InputError that names the
/// file, for an inconsistent cloud, one that the format cannot hold, or a file that cannot be
/// written.
///
/// - .pcd: binary, also where the points come from an ascii or a compressed file.
/// - .ply: little-endian binary; a packed field "rgb" becomes red, green and blue.
/// - .npy: N x C float32 if all fields are float32, else float64; the first fields are x, y, z.
/// - .bin: only a cloud of the fields that are read from it, each float32.
///
/// Field "_" and bytes of a point outside its fields are written to .pcd only (the field) or not at
/// all (the bytes). Only .pcd keeps the rows of an organised cloud. Elements of a field become one
/// property or column each outside .pcd.
void write_cloud(const std::filesystem::path& file, const PointCloud2Message& cloud);
/// Returns what write_cloud writes.
[[nodiscard]] std::string cloud_bytes(const std::filesystem::path& file,
                                      const PointCloud2Message& cloud);

}  // namespace penumbra::io
