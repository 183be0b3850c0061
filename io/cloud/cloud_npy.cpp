// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <io/cloud/cloud_formats-inl.hpp>
#include <io/files/npy.hpp>

namespace penumbra::io::cloud_formats {
namespace {

template <typename T>
void append_npy_rows(const PointCloud2Message& cloud, const std::vector<Column>& columns,
                     std::string& file) {
  file.reserve(file.size() + sizeof(T) * columns.size() * cloud.width * cloud.height);
  for_each_point(cloud, [&](const std::byte* point) {
    for (const Column& column : columns)
      with_type(column.datatype, [&](auto number) {
        std::memcpy(&number, point + column.offset, sizeof number);
        const T value = static_cast<T>(number);
        file.append(reinterpret_cast<const char*>(&value), sizeof value);
      });
  });
}

}  // namespace

StoredCloud parse_npy(Bytes bytes) {
  NpyHeader header;
  if (const std::string fault = parse_npy_header(bytes, header); !fault.empty())
    throw InputError(fault);
  if (header.shape.size() != 2 || header.shape[1] < 3 || header.shape[1] > most_point_bytes ||
      (header.type != "<f4" && header.type != "<f8"))
    throw InputError(
        "an array of " + in_quotes(header.type) + " with " + std::to_string(header.shape.size()) +
        " dimensions is no cloud; use N x C float32 or float64, C >= 3" +
        (header.shape.size() == 2 && header.shape[0] == 3 ? "; is it transposed?" : ""));
  PointCloud2Message cloud;
  const std::uint8_t type =
      header.type == "<f4" ? PointFieldMessage::float32 : PointFieldMessage::float32 + 1;
  for (std::uint64_t i = 0; i < header.shape[1]; ++i)
    add_field(cloud, i < 3 ? std::string(1, "xyz"[i]) : "f" + std::to_string(i), type);
  set_size(cloud, header.shape[0]);
  StoredCloud stored = take_binary(std::move(cloud), std::move(bytes), header.size);
  if (header.is_fortran) make_points(stored);
  return stored;
}

std::string format_npy(const PointCloud2Message& cloud) {
  const std::vector<Column> columns = columns_of(cloud);
  if (columns.size() < 3 || columns[0].name != "x" || columns[1].name != "y" ||
      columns[2].name != "z")
    throw InputError(".npy holds x y z first, and the cloud's fields start otherwise; write .pcd");
  const bool is_float = std::all_of(columns.begin(), columns.end(), [](const Column& column) {
    return column.datatype == PointFieldMessage::float32;
  });
  const std::array shape{std::uint64_t{cloud.width} * cloud.height, std::uint64_t{columns.size()}};
  std::string file = npy_header(is_float ? "<f4" : "<f8", shape);
  if (is_float)
    append_npy_rows<float>(cloud, columns, file);
  else
    append_npy_rows<double>(cloud, columns, file);
  return file;
}

}  // namespace penumbra::io::cloud_formats
