// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include <io/cloud/cloud_formats-inl.hpp>

namespace penumbra::io::cloud_formats {
namespace {

constexpr std::uint64_t most_row_bytes = std::numeric_limits<std::uint32_t>::max();

std::size_t bytes_of_field(const PointFieldMessage& field) {
  return std::size_t{number_types[field.datatype].size} * field.count;
}

template <typename T>
void parse_into(std::string_view word, std::byte* to) {
  using Parsed = std::conditional_t<std::is_floating_point_v<T>, double, T>;
  const auto value = parse_number<Parsed>(word);
  if (!value) damaged(in_quotes(word) + " is no number of the field's type");
  if constexpr (std::is_same_v<T, float>)
    if (std::isfinite(*value) && std::abs(*value) > double{std::numeric_limits<float>::max()})
      throw InputError(in_quotes(word) + " does not fit into float32");
  const T number = static_cast<T>(*value);
  std::memcpy(to, &number, sizeof number);
}

/// Calls use(first byte, datatype) for each number of each point.
template <typename F>
void for_each_number(StoredCloud& stored, const F& use) {
  std::byte* at = stored.data.data();
  for_each_point(stored.cloud, [&](const std::byte*) {
    for (const PointFieldMessage& field : stored.cloud.fields)
      for (std::uint32_t i = 0; i < field.count; ++i) {
        use(at, field.datatype);
        at += number_types[field.datatype].size;
      }
  });
}

}  // namespace

std::uint8_t datatype_of(char kind, std::uint64_t size, std::string_view field) {
  for (std::size_t i = 1; i < number_types.size(); ++i)
    if (number_types[i].kind == kind && number_types[i].size == size)
      return static_cast<std::uint8_t>(i);
  throw InputError("field " + in_quotes(field) + " has an unknown type of " + std::to_string(size) +
                   " bytes; use integers of 1, 2, 4 or 8, or floats of 4 or 8");
}

void add_field(PointCloud2Message& cloud, std::string name, std::uint8_t datatype,
               std::uint64_t count) {
  if (count < 1 || count > most_point_bytes ||
      cloud.point_step + count * number_types[datatype].size > most_point_bytes)
    throw InputError("field " + in_quotes(name) + " has " + std::to_string(count) +
                     " elements; a point takes 1 to " + std::to_string(most_point_bytes) +
                     " bytes");
  cloud.fields.push_back(
      {std::move(name), cloud.point_step, datatype, static_cast<std::uint32_t>(count)});
  cloud.point_step += static_cast<std::uint32_t>(bytes_of_field(cloud.fields.back()));
}

void set_size(PointCloud2Message& cloud, std::uint64_t width, std::uint64_t height) {
  if (cloud.fields.empty()) throw InputError("its points have no fields");
  if (height > 0 && width > most_cloud_points / height)
    throw InputError("it has " + std::to_string(width) + " x " + std::to_string(height) +
                     " points, and the limit is " + std::to_string(most_cloud_points) +
                     "; split it or leave points out");
  if (width > most_row_bytes / cloud.point_step || height > most_row_bytes)
    throw InputError("the header names " + std::to_string(width) + " x " + std::to_string(height) +
                     " points of " + std::to_string(cloud.point_step) +
                     " bytes; a row takes less than 4 GiB");
  cloud.width = static_cast<std::uint32_t>(width);
  cloud.height = static_cast<std::uint32_t>(height);
  cloud.row_step = cloud.width * cloud.point_step;
}

void check_end(std::span<const std::byte> rest) {
  if (std::any_of(rest.begin(), rest.end(), [](std::byte byte) { return byte != std::byte{0}; }))
    damaged(std::to_string(rest.size()) + " bytes follow the last point");
}

StoredCloud take_binary(PointCloud2Message cloud, Bytes bytes, std::size_t offset, bool is_end) {
  const std::uint64_t size = total_bytes(cloud);
  if (size > bytes.size() - offset)
    damaged("the points take " + std::to_string(size) + " bytes, and " +
            std::to_string(bytes.size() - offset) + " follow the header");
  if (is_end) check_end(std::span(bytes).subspan(offset + size));
  StoredCloud stored;
  stored.cloud = std::move(cloud);
  stored.data = std::move(bytes);
  stored.data.erase(stored.data.begin(), stored.data.begin() + static_cast<std::ptrdiff_t>(offset));
  stored.data.resize(size);
  stored.cloud.data = stored.data;
  return stored;
}

StoredCloud take_text(PointCloud2Message cloud, std::string_view text, bool is_end) {
  std::uint64_t numbers = std::uint64_t{cloud.width} * cloud.height;  // at most 2^64 bytes in all
  std::uint64_t per_point = 0;
  for (const PointFieldMessage& field : cloud.fields) per_point += field.count;
  numbers *= per_point;
  // A number and the space behind it take two characters.
  if (numbers > text.size() / 2 + 1)
    damaged("the header names " + std::to_string(numbers) + " numbers, and " +
            std::to_string(text.size()) + " characters follow");
  StoredCloud stored;
  stored.data.resize(total_bytes(cloud));
  stored.cloud = std::move(cloud);
  stored.cloud.data = stored.data;
  for_each_number(stored, [&](std::byte* to, std::uint8_t datatype) {
    const std::string_view word = take_word(text);
    if (word.empty()) damaged("it ends before its last point");
    with_type(datatype, [&]<typename T>(T) { parse_into<T>(word, to); });
  });
  if (is_end && !take_word(text).empty()) damaged("more text follows the last point");
  return stored;
}

void make_points(StoredCloud& stored) {
  const PointCloud2Message& cloud = stored.cloud;
  Bytes points(stored.data.size());
  const std::byte* from = stored.data.data();
  for (const PointFieldMessage& field : cloud.fields) {
    const std::size_t size = bytes_of_field(field);
    for (std::size_t at = field.offset; at < points.size(); at += cloud.point_step, from += size)
      std::memcpy(points.data() + at, from, size);
  }
  stored.data = std::move(points);
  stored.cloud.data = stored.data;
}

void swap_bytes(StoredCloud& stored) {
  for_each_number(stored, [](std::byte* number, std::uint8_t datatype) {
    std::reverse(number, number + number_types[datatype].size);
  });
}

std::vector<Column> columns_of(const PointCloud2Message& cloud) {
  std::vector<Column> columns;
  for (const PointFieldMessage& field : cloud.fields) {
    if (field.name == "_") continue;
    for (std::uint32_t i = 0; i < field.count; ++i)
      columns.push_back({field.count == 1 ? field.name : field.name + "_" + std::to_string(i),
                         field.offset + i * number_types[field.datatype].size, field.datatype});
  }
  return columns;
}

void append_pieces(const PointCloud2Message& cloud, const std::vector<Piece>& pieces,
                   std::string& file) {
  std::vector<Piece> runs;
  std::size_t size = 0;
  for (const Piece& piece : pieces) {
    const bool follows = !runs.empty() && runs.back().offset + runs.back().size == piece.offset;
    if (follows) runs.back().size += piece.size;
    if (!follows) runs.push_back(piece);
    size += piece.size;
  }
  file.reserve(file.size() + size * cloud.width * cloud.height);
  for_each_point(cloud, [&](const std::byte* point) {
    for (const Piece& run : runs)
      file.append(reinterpret_cast<const char*>(point + run.offset), run.size);
  });
}

}  // namespace penumbra::io::cloud_formats
