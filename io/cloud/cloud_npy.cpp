// SPDX-License-Identifier: Apache-2.0
// Format: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include <algorithm>
#include <cstring>
#include <utility>

#include <io/cloud/cloud_formats-inl.hpp>

namespace penumbra::io::cloud_formats {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr std::size_t npy_alignment = 64;  // of the first sample

struct NpyHeader {
  std::string_view type;      // of a plain array
  PointCloud2Message record;  // the fields of a structured array
  bool is_fortran = false;
  std::vector<std::uint64_t> shape;
};

bool is_python_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/// Takes a string with its first quote, a word, a number or a sign; empty at the end.
std::string_view take_token(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (text.empty()) return {};
  std::size_t length = 1;
  const bool is_string = text[0] == '\'' || text[0] == '"';
  if (is_string)
    length = std::min(text.find(text[0], 1), text.size());
  else if (is_python_word(text[0]))
    while (length < text.size() && is_python_word(text[length])) ++length;
  const std::string_view token = text.substr(0, length);
  text.remove_prefix(std::min(length + (is_string ? 1 : 0), text.size()));
  return token;
}

void take_sign(std::string_view& text, std::string_view sign) {
  if (take_token(text) != sign) damaged("NumPy: the header is no Python dictionary of an array");
}

std::string_view take_string(std::string_view& text) {
  const std::string_view token = take_token(text);
  if (!token.starts_with('\'') && !token.starts_with('"'))
    damaged("NumPy: " + in_quotes(token) + " in the header is no string");
  return token.substr(1);
}

std::vector<std::uint64_t> take_shape(std::string_view& text) {
  take_sign(text, "(");
  std::vector<std::uint64_t> shape;
  for (std::string_view token = take_token(text); token != ")"; token = take_token(text)) {
    if (token == ",") continue;
    const auto size = parse_number<std::uint64_t>(token);
    if (!size) damaged("NumPy: " + in_quotes(token) + " in the header is no size");
    shape.push_back(*size);
  }
  return shape;
}

/// Adds a field of a type such as <f4.
void add_npy_field(PointCloud2Message& cloud, std::string_view name, std::string_view type,
                   std::uint64_t count) {
  const auto size = parse_number<std::uint64_t>(type.substr(std::min<std::size_t>(type.size(), 2)));
  const std::size_t kind = std::string_view("iufV").find(type.size() > 1 ? type[1] : '?');
  if (!size || kind == std::string_view::npos || (type[0] != '<' && type[0] != '|'))
    throw InputError("NumPy: field " + in_quotes(name) + " has the type " + in_quotes(type) +
                     "; use little-endian integers or floats");
  if (type[1] == 'V')
    add_field(cloud, "_", 2, *size);  // padding
  else
    add_field(cloud, std::string(name), datatype_of("IUF"[kind], *size, name), count);
}

/// Takes [('x', '<f4'), ('normal', '<f4', (3,)), ...] after its first bracket.
void take_npy_fields(std::string_view& text, PointCloud2Message& cloud) {
  for (std::string_view token = take_token(text); token != "]"; token = take_token(text)) {
    if (token == ",") continue;
    if (token != "(") damaged("NumPy: a field in the header is no tuple");
    const std::string_view name = take_string(text);
    take_sign(text, ",");
    const std::string_view type = take_string(text);
    token = take_token(text);
    std::vector<std::uint64_t> shape;
    if (token == ",") {
      shape = take_shape(text);
      token = take_token(text);
    }
    if (token != ")") damaged("NumPy: a field in the header is no tuple");
    constexpr std::uint64_t too_many = most_point_bytes + 1;
    std::uint64_t count = 1;
    for (const std::uint64_t n : shape) count = std::min(count, too_many) * std::min(n, too_many);
    add_npy_field(cloud, name, type, count);
  }
}

NpyHeader parse_npy_header(std::string_view text) {
  NpyHeader header;
  take_sign(text, "{");
  for (std::string_view token = take_token(text); token != "}"; token = take_token(text)) {
    if (token == ",") continue;
    const std::string_view key = token.substr(std::min<std::size_t>(token.size(), 1));
    take_sign(text, ":");
    if (key == "shape") {
      header.shape = take_shape(text);
      continue;
    }
    const std::string_view value = take_token(text);
    if (key == "fortran_order") header.is_fortran = value == "True";
    if (key != "descr") continue;
    if (value == "[")
      take_npy_fields(text, header.record);
    else
      header.type = value.substr(std::min<std::size_t>(value.size(), 1));
  }
  return header;
}

/// Returns the length of what stands before the samples, and in `text` the dictionary.
std::size_t split_npy(std::string_view file, std::string_view& text) {
  if (!file.starts_with(npy_magic) || file.size() < 12) damaged("NumPy: it is no NumPy file");
  const char version = file[6];
  if (version < 1 || version > 3)
    throw InputError("NumPy: it has format version " + std::to_string(version) +
                     "; 1 to 3 are read");
  const std::size_t begin = version == 1 ? 10 : 12;
  std::size_t length = 0;
  for (std::size_t i = begin; i-- > 8;) length = length << 8U | static_cast<unsigned char>(file[i]);
  if (length > most_header_bytes || length > file.size() - begin)
    damaged("NumPy: its header has " + std::to_string(length) + " bytes");
  text = file.substr(begin, length);
  return begin + length;
}

void add_npy_columns(const NpyHeader& header, PointCloud2Message& cloud) {
  if (header.shape.size() != 2 || header.shape[1] < 3 ||
      (header.type != "<f4" && header.type != "<f8"))
    throw InputError("NumPy: an array of " + in_quotes(header.type) + " with " +
                     std::to_string(header.shape.size()) +
                     " dimensions is no cloud; use N x C float32 or float64, C >= 3");
  for (std::uint64_t i = 0; i < header.shape[1]; ++i)
    add_npy_field(cloud,
                  i < 3 ? std::string(1, static_cast<char>('x' + i)) : "f" + std::to_string(i),
                  header.type, 1);
}

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
  std::string_view text;
  const std::size_t offset = split_npy(text_of(bytes), text);
  NpyHeader header = parse_npy_header(text);
  PointCloud2Message cloud = std::move(header.record);
  const bool is_plain = cloud.fields.empty();
  if (is_plain) add_npy_columns(header, cloud);
  if (!is_plain && header.shape.size() != 1)
    throw InputError("NumPy: a structured array of " + std::to_string(header.shape.size()) +
                     " dimensions is no cloud; use one");
  set_size(cloud, header.shape[0]);
  StoredCloud stored = take_binary(std::move(cloud), std::move(bytes), offset);
  if (is_plain && header.is_fortran) make_points(stored);
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
  std::string text = std::string("{'descr': '") + (is_float ? "<f4" : "<f8") +
                     "', 'fortran_order': False, 'shape': (" +
                     std::to_string(std::uint64_t{cloud.width} * cloud.height) + ", " +
                     std::to_string(columns.size()) + "), }";
  constexpr std::size_t before = npy_magic.size() + 4;
  const std::size_t whole = (before + text.size() + npy_alignment) / npy_alignment * npy_alignment;
  text.resize(whole - before - 1, ' ');
  text += '\n';
  std::string file(npy_magic);
  file += {1, 0, static_cast<char>(text.size() & 255U), static_cast<char>(text.size() >> 8U)};
  file += text;
  if (is_float)
    append_npy_rows<float>(cloud, columns, file);
  else
    append_npy_rows<double>(cloud, columns, file);
  return file;
}

}  // namespace penumbra::io::cloud_formats
