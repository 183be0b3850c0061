// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include <io/cloud/cloud_file.hpp>
#include <io/cloud/cloud_formats-inl.hpp>
#include <io/files/disk_file.hpp>

namespace penumbra::io {
namespace {

using cloud_formats::number_types;

constexpr std::uint64_t most_cloud_bytes = std::uint64_t{1} << 30U;

struct CloudFormat {
  std::string_view extension;
  StoredCloud (*parse)(cloud_formats::Bytes bytes);
  std::string (*format)(const PointCloud2Message& cloud);
};
constexpr std::array<CloudFormat, 4> cloud_formats_by_extension{
    {{".pcd", cloud_formats::parse_pcd, cloud_formats::format_pcd},
     {".ply", cloud_formats::parse_ply, cloud_formats::format_ply},
     {".npy", cloud_formats::parse_npy, cloud_formats::format_npy},
     {".bin", cloud_formats::parse_kitti, cloud_formats::format_kitti}}};

/// Returns null for an unknown extension.
const CloudFormat* find_cloud_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  for (const CloudFormat& format : cloud_formats_by_extension)
    if (format.extension == extension) return &format;
  return nullptr;
}

const CloudFormat& require_cloud_format(const std::filesystem::path& file) {
  const CloudFormat* format = find_cloud_format(file);
  if (format == nullptr)
    throw InputError(file.string() + ": is no known point cloud; use .pcd, .ply, .npy or .bin");
  return *format;
}

cloud_formats::Bytes read_cloud_bytes(const std::filesystem::path& file) {
  InputFile input;
  input.open(file).require();
  if (input.size() > most_cloud_bytes)
    throw InputError(file.string() + ": has " + std::to_string(input.size()) +
                     " bytes, the limit is " + std::to_string(most_cloud_bytes) + "; split it");
  cloud_formats::Bytes bytes(input.size());
  if (input.read(bytes.data(), bytes.size()) != bytes.size())
    throw InputError(file.string() + ": cannot be read to its end; check the disk");
  return bytes;
}

void check_cloud_field(const PointFieldMessage& field, std::uint32_t point_step) {
  const std::string name = "the cloud's field " + cloud_formats::in_quotes(field.name);
  const bool is_word =
      !field.name.empty() && std::none_of(field.name.begin(), field.name.end(),
                                          [](unsigned char c) { return c <= ' ' || c == 127; });
  if (!is_word) throw InputError(name + " has no name without spaces");
  if (field.datatype < 1 || field.datatype >= number_types.size())
    throw InputError(name + " has the unknown datatype " + std::to_string(field.datatype));
  const std::uint64_t bytes = std::uint64_t{number_types[field.datatype].size} * field.count;
  if (bytes == 0 || field.offset + bytes > point_step)
    throw InputError(name + " does not lie within a point of " + std::to_string(point_step) +
                     " bytes");
}

/// The writers trust a cloud that passed.
void check_cloud_layout(const PointCloud2Message& cloud) {
  if (cloud.is_bigendian) throw InputError("the cloud is big-endian, which is not written");
  if (cloud.fields.empty()) throw InputError("the cloud has no fields");
  std::uint64_t bytes = 0;
  for (const PointFieldMessage& field : cloud.fields) {
    check_cloud_field(field, cloud.point_step);
    bytes += std::uint64_t{number_types[field.datatype].size} * field.count;
  }
  if (bytes > cloud_formats::most_point_bytes)
    throw InputError("the cloud's fields take " + std::to_string(bytes) +
                     " bytes per point, the limit is " +
                     std::to_string(cloud_formats::most_point_bytes));
  if (std::uint64_t{cloud.width} * cloud.point_step > cloud.row_step ||
      cloud_formats::total_bytes(cloud) > cloud.data.size())
    throw InputError("the cloud has fewer data than its width, height and steps say");
}

/// The fields of a .bin, which has no header: of KITTI, nuScenes and others.
const std::vector<std::vector<std::string_view>> bin_forms{{"x", "y", "z", "intensity"},
                                                           {"x", "y", "z", "intensity", "ring"},
                                                           {"x", "y", "z", "f3", "f4", "f5"},
                                                           {"x", "y", "z"}};

/// Returns the only form that a .bin can have. Numbers behind x, y and z are not negative; if a
/// coordinate is, a wrong form would have it there.
const std::vector<std::string_view>& bin_fields(std::span<const std::byte> bytes) {
  std::vector<float> numbers(bytes.size() / sizeof(float));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  std::vector<const std::vector<std::string_view>*> possible, shown;
  std::size_t fitting = 0;  // by size
  const bool is_any_negative = std::ranges::any_of(numbers, [](float n) { return n < 0.0F; });
  for (const auto& form : bin_forms) {
    if (bytes.size() % (sizeof(float) * form.size()) != 0) continue;
    ++fitting;
    bool is_possible = true;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      is_possible &= !(numbers[i] < 0.0F) || i % form.size() <= 2;
    if (!is_possible) continue;
    possible.push_back(&form);
    if (is_any_negative && form.size() > 3) shown.push_back(&form);
  }
  if (fitting == 0)
    cloud_formats::damaged(std::to_string(bytes.size()) +
                           " bytes are no points of 4 float32 (KITTI), nor of 3, 5 or 6");
  if (numbers.empty() || (fitting == 1 && possible.size() == 1)) return *possible.front();
  if (shown.size() == 1) return *shown.front();
  throw InputError(
      "it may have 3, 4 (KITTI), 5, 6 or more numbers a point; write .npy, which says so: "
      "numpy.save(\"x.npy\", numpy.fromfile(\"x.bin\", \"float32\").reshape(-1, N))");
}

/// Puts the file's name before the message of an InputError.
template <typename F>
auto with_cloud_name(const std::filesystem::path& file, const F& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

}  // namespace

StoredCloud cloud_formats::parse_kitti(Bytes bytes) {
  PointCloud2Message cloud;
  for (const std::string_view name : bin_fields(bytes))
    add_field(cloud, std::string(name), PointFieldMessage::float32);
  set_size(cloud, bytes.size() / cloud.point_step);
  return take_binary(std::move(cloud), std::move(bytes), 0);
}

std::string cloud_formats::format_kitti(const PointCloud2Message& cloud) {
  std::vector<Piece> pieces;
  std::vector<std::string_view> names;
  std::string all;
  bool are_floats = true;
  const std::vector<Column> columns = columns_of(cloud);
  for (const Column& column : columns) {
    const bool is_float = column.datatype == PointFieldMessage::float32;
    are_floats &= is_float;
    names.push_back(column.name);
    all += " " + column.name + (is_float ? "" : " (not float32)");
    pieces.push_back({column.offset, number_types[column.datatype].size});
  }
  if (!are_floats || std::ranges::find(bin_forms, names) == bin_forms.end())
    throw InputError(".bin holds x y z intensity, as float32, and the cloud has" + all +
                     "; write .pcd");
  std::string file;
  append_pieces(cloud, pieces, file);
  return file;
}

bool is_cloud_file(const std::filesystem::path& file) { return find_cloud_format(file) != nullptr; }

StoredCloud read_cloud(const std::filesystem::path& file) {
  const CloudFormat& format = require_cloud_format(file);
  cloud_formats::Bytes bytes = read_cloud_bytes(file);
  return with_cloud_name(file, [&] { return format.parse(std::move(bytes)); });
}

std::string cloud_bytes(const std::filesystem::path& file, const PointCloud2Message& cloud) {
  const CloudFormat& format = require_cloud_format(file);
  return with_cloud_name(file, [&] {
    check_cloud_layout(cloud);
    return format.format(cloud);
  });
}

void write_cloud(const std::filesystem::path& file, const PointCloud2Message& cloud) {
  const std::string bytes = cloud_bytes(file, cloud);
  write_file(file, bytes.data(), bytes.size());
}

}  // namespace penumbra::io
