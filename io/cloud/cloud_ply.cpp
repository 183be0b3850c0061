// SPDX-License-Identifier: Apache-2.0
// Format: G. Turk, "The PLY polygon file format", https://paulbourke.net/dataformats/ply/
#include <algorithm>
#include <cstring>
#include <utility>

#include <io/cloud/cloud_formats-inl.hpp>

namespace penumbra::io::cloud_formats {
namespace {

struct PlyProperty {
  std::uint8_t datatype = 0;
  std::uint8_t count_datatype = 0;  // of a list
  std::string_view name;
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::string_view format;
  std::vector<PlyElement> elements;
};

std::uint8_t ply_datatype(std::string_view name) {
  for (std::size_t i = 1; i < number_types.size(); ++i)
    if (number_types[i].ply == name || number_types[i].ply_sized == name)
      return static_cast<std::uint8_t>(i);
  throw InputError("PLY: " + in_quotes(name) +
                   " is no type that is known; use char to uint, int64, uint64, float or double");
}

PlyProperty parse_ply_property(std::string_view line) {
  PlyProperty property;
  std::string_view type = take_word(line);
  if (type == "list") {
    property.count_datatype = ply_datatype(take_word(line));
    if (number_types[property.count_datatype].kind == 'F')
      damaged("PLY: the counts of a list are no integers");
    type = take_word(line);
  }
  property.datatype = ply_datatype(type);
  property.name = take_word(line);
  if (property.name.empty() || !take_word(line).empty())
    damaged("PLY: a property line is not a type and a name");
  return property;
}

PlyElement parse_ply_element(std::string_view line) {
  PlyElement element;
  element.name = take_word(line);
  const auto count = parse_number<std::uint64_t>(take_word(line));
  if (!count) damaged("PLY: element " + in_quotes(element.name) + " has no count");
  element.count = *count;
  return element;
}

PlyHeader take_ply_header(std::string_view& rest) {
  if (take_line(rest) != "ply") damaged("PLY: the first line is not 'ply'");
  PlyHeader header;
  for (;;) {
    if (rest.empty()) damaged("PLY: no line 'end_header' in the first 65536 bytes");
    std::string_view line = take_line(rest);
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") return header;
    if (keyword == "format") header.format = take_word(line);
    if (keyword == "element") header.elements.push_back(parse_ply_element(line));
    if (keyword != "property") continue;
    if (header.elements.empty()) damaged("PLY: a property comes before any element");
    header.elements.back().properties.push_back(parse_ply_property(line));
  }
}

/// Skips elements of the body.
class PlyBody {
 public:
  PlyBody(std::string_view rest, std::string_view format)
      : rest_(rest), is_text_(format == "ascii"), is_big_(format == "binary_big_endian") {
    if (!is_text_ && !is_big_ && format != "binary_little_endian")
      damaged("PLY: unknown format " + in_quotes(format));
  }

  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool is_text() const { return is_text_; }
  [[nodiscard]] bool is_big() const { return is_big_; }

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
        for (std::uint64_t n = property.count_datatype != 0 ? take_count(property) : 1; n > 0; --n)
          take(property.datatype);
  }

 private:
  std::string_view take(std::uint8_t datatype) {
    const std::size_t size = number_types[datatype].size;
    const std::string_view number = is_text_ ? take_word(rest_) : rest_.substr(0, size);
    if (is_text_ ? number.empty() : number.size() < size)
      damaged("PLY: it ends before its last vertex");
    if (!is_text_) rest_.remove_prefix(size);
    return number;
  }

  std::uint64_t take_count(const PlyProperty& list) {
    std::string number(take(list.count_datatype));
    const auto count = with_type(list.count_datatype, [&]<typename T>(T value) {
      if (is_text_) return parse_number<std::int64_t>(number).value_or(-1);
      if (is_big_) std::reverse(number.begin(), number.end());
      std::memcpy(&value, number.data(), sizeof value);
      return static_cast<std::int64_t>(value);
    });
    if (count < 0) damaged("PLY: the count of a list " + in_quotes(list.name) + " is no count");
    return static_cast<std::uint64_t>(count);
  }

  std::string_view rest_;
  bool is_text_, is_big_;
};

PointCloud2Message ply_cloud(const PlyElement& vertex) {
  PointCloud2Message cloud;
  for (const PlyProperty& property : vertex.properties) {
    if (property.count_datatype != 0)
      throw InputError("PLY: the list " + in_quotes(property.name) +
                       " of element vertex is not supported; remove it");
    add_field(cloud, std::string(property.name), property.datatype);
  }
  set_size(cloud, vertex.count);
  return cloud;
}

}  // namespace

StoredCloud parse_ply(Bytes bytes) {
  std::string_view rest = text_of(bytes).substr(0, most_header_bytes);
  const std::size_t header_part = rest.size();
  const PlyHeader header = take_ply_header(rest);
  PlyBody body(text_of(bytes).substr(header_part - rest.size()), header.format);
  auto element = header.elements.begin();
  for (; element != header.elements.end() && element->name != "vertex"; ++element)
    body.skip(*element);
  if (element == header.elements.end()) throw InputError("PLY: it has no element vertex");
  PointCloud2Message cloud = ply_cloud(*element);
  const bool is_end = element + 1 == header.elements.end();
  if (body.is_text()) return take_text(std::move(cloud), body.rest(), is_end);
  const std::size_t offset = bytes.size() - body.rest().size();
  StoredCloud stored = take_binary(std::move(cloud), std::move(bytes), offset, is_end);
  if (body.is_big()) swap_bytes(stored);
  return stored;
}

std::string format_ply(const PointCloud2Message& cloud) {
  std::vector<Column> columns;
  for (Column& column : columns_of(cloud)) {
    if (column.name == "rgb" && number_types[column.datatype].size == 4) {  // PCL's packing
      columns.push_back({"red", column.offset + 2, 2});
      columns.push_back({"green", column.offset + 1, 2});
      columns.push_back({"blue", column.offset, 2});
    } else {
      columns.push_back(std::move(column));
    }
  }
  std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(std::uint64_t{cloud.width} * cloud.height) + "\n";
  std::vector<Piece> pieces;
  for (const Column& column : columns) {
    const NumberType& type = number_types[column.datatype];
    file += "property " + std::string(type.ply) + " " + column.name + "\n";
    pieces.push_back({column.offset, type.size});
  }
  file += "end_header\n";
  append_pieces(cloud, pieces, file);
  return file;
}

}  // namespace penumbra::io::cloud_formats
