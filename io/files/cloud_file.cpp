// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include <io/files/cloud_file.hpp>
#include <io/files/disk_file.hpp>

namespace penumbra::io {
namespace {

static_assert(std::endian::native == std::endian::little, "points are written unchanged");

Rgb8 color_at(ImageView<const Rgb8> color, std::uint32_t pixel) {
  const auto width = static_cast<std::uint32_t>(color.width);
  return color(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
}

template <typename T>
void append(const T& value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// `append_color(color, bytes)` writes a point's colour.
template <typename F>
void write(const std::filesystem::path& file, std::string bytes, const PointCloud& cloud,
           ImageView<const Rgb8> color, const F& append_color) {
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    for (const float value : cloud.points[i]) append(value, bytes);
    if (!color.empty()) append_color(color_at(color, cloud.pixels[i]), bytes);
  }
  write_file(file, bytes.data(), bytes.size());
}

}  // namespace

void write_pcd(const std::filesystem::path& file, const PointCloud& cloud,
               ImageView<const Rgb8> color) {
  const std::string count = std::to_string(cloud.points.size());
  const bool has_color = !color.empty();
  const auto line = [&](const char* name, const char* values, const char* of_color) {
    return std::string(name) + values + (has_color ? of_color : "") + "\n";
  };
  std::string header = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  header += line("FIELDS", " x y z", " rgb") + line("SIZE", " 4 4 4", " 4") +
            line("TYPE", " F F F", " F") + line("COUNT", " 1 1 1", " 1");
  header +=
      "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
  write(file, std::move(header), cloud, color, [](Rgb8 c, std::string& bytes) {
    append(static_cast<std::uint32_t>(c.r << 16 | c.g << 8 | c.b), bytes);  // PCL's packing
  });
}

void write_ply(const std::filesystem::path& file, const PointCloud& cloud,
               ImageView<const Rgb8> color) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(cloud.points.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!color.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "end_header\n";
  write(file, std::move(header), cloud, color,
        [](Rgb8 c, std::string& bytes) { append(c, bytes); });
}

}  // namespace penumbra::io
