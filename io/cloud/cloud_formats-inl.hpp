// SPDX-License-Identifier: Apache-2.0
// What the formats of point clouds share. All throw InputError without the file's name.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/mesh_formats.hpp>

#include <io/cloud/cloud_file.hpp>

namespace penumbra::io::cloud_formats {

using mesh_formats::in_quotes;
using mesh_formats::parse_number;
using mesh_formats::take_line;
using mesh_formats::take_word;

static_assert(std::endian::native == std::endian::little, "numbers are copied unchanged");

using Bytes = std::vector<std::byte>;

inline constexpr std::size_t most_header_bytes = 1U << 16U;
inline constexpr std::uint32_t most_point_bytes = 1U << 16U;

struct NumberType {
  char kind;  ///< as in PCD: I(nteger), U(nsigned), F(loat)
  std::uint32_t size;
  std::string_view ply, ply_sized;
};

/// The types of numbers by their value in PointField; the first is none. PointField does not have
/// the last two, which files have.
inline constexpr std::array<NumberType, 11> number_types{{{},
                                                          {'I', 1, "char", "int8"},
                                                          {'U', 1, "uchar", "uint8"},
                                                          {'I', 2, "short", "int16"},
                                                          {'U', 2, "ushort", "uint16"},
                                                          {'I', 4, "int", "int32"},
                                                          {'U', 4, "uint", "uint32"},
                                                          {'F', 4, "float", "float32"},
                                                          {'F', 8, "double", "float64"},
                                                          {'I', 8, "int64", "int64"},
                                                          {'U', 8, "uint64", "uint64"}}};

/// Calls f(T{}) with the type of a valid value of PointField.
template <typename F>
auto with_type(std::uint8_t datatype, const F& f) {
  switch (datatype) {
    case 1:
      return f(std::int8_t{});
    case 2:
      return f(std::uint8_t{});
    case 3:
      return f(std::int16_t{});
    case 4:
      return f(std::uint16_t{});
    case 5:
      return f(std::int32_t{});
    case 6:
      return f(std::uint32_t{});
    case 7:
      return f(float{});
    case 9:
      return f(std::int64_t{});
    case 10:
      return f(std::uint64_t{});
    default:
      return f(double{});
  }
}

/// Throws for a file that was cut off or altered.
[[noreturn]] inline void damaged(const std::string& what) {
  throw InputError(what + "; the file is truncated or damaged, export or copy it again");
}

inline std::string_view text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns PointField's value for a type. `field`: for the message.
[[nodiscard]] std::uint8_t datatype_of(char kind, std::uint64_t size, std::string_view field);

/// Appends a field behind the others of a point.
void add_field(PointCloud2Message& cloud, std::string name, std::uint8_t datatype,
               std::uint64_t count = 1);

/// Sets the size of a cloud whose fields are complete. Throws above most_cloud_points.
void set_size(PointCloud2Message& cloud, std::uint64_t width, std::uint64_t height = 1);

/// Returns what all points take.
[[nodiscard]] inline std::uint64_t total_bytes(const PointCloud2Message& cloud) {
  return std::uint64_t{cloud.row_step} * cloud.height;
}

/// Throws unless the bytes behind the points are zeros, with which old versions of PCL fill a page.
void check_end(std::span<const std::byte> rest);

/// Takes the points from `offset` on. `is_end`: only zeros may follow.
[[nodiscard]] StoredCloud take_binary(PointCloud2Message cloud, Bytes bytes, std::size_t offset,
                                      bool is_end = true);

/// Takes the points from words of text. `is_end`: no more words may follow.
[[nodiscard]] StoredCloud take_text(PointCloud2Message cloud, std::string_view text,
                                    bool is_end = true);

/// Reorders data that hold all values of the first field, then of the second and so on.
void make_points(StoredCloud& stored);

/// Reverses the bytes of each number.
void swap_bytes(StoredCloud& stored);

/// A number of a point.
struct Column {
  std::string name;
  std::uint32_t offset;
  std::uint8_t datatype;
};

/// Returns the numbers of a point without padding.
[[nodiscard]] std::vector<Column> columns_of(const PointCloud2Message& cloud);

/// Calls use(first byte) for each point.
template <typename F>
void for_each_point(const PointCloud2Message& cloud, const F& use) {
  for (std::size_t v = 0; v < cloud.height; ++v)
    for (std::size_t u = 0; u < cloud.width; ++u)
      use(cloud.data.data() + v * cloud.row_step + u * cloud.point_step);
}

/// A part of each point's bytes.
struct Piece {
  std::uint32_t offset, size;
};

/// Appends pieces of each point to a file's bytes.
void append_pieces(const PointCloud2Message& cloud, const std::vector<Piece>& pieces,
                   std::string& file);

// A reader gets the whole file. A writer gets a consistent cloud and returns the whole file.
[[nodiscard]] StoredCloud parse_pcd(Bytes bytes);
[[nodiscard]] StoredCloud parse_ply(Bytes bytes);
[[nodiscard]] StoredCloud parse_npy(Bytes bytes);
[[nodiscard]] StoredCloud parse_kitti(Bytes bytes);
[[nodiscard]] std::string format_pcd(const PointCloud2Message& cloud);
[[nodiscard]] std::string format_ply(const PointCloud2Message& cloud);
[[nodiscard]] std::string format_npy(const PointCloud2Message& cloud);
[[nodiscard]] std::string format_kitti(const PointCloud2Message& cloud);

}  // namespace penumbra::io::cloud_formats
