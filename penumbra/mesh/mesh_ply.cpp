// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include <penumbra/mesh/mesh_formats.hpp>

namespace penumbra::mesh_formats {
namespace {

/// A type of numbers, each of which fits a double.
struct Type {
  std::size_t size;
  bool is_real;
  double (*read)(const char* bytes);
};

template <typename T>
constexpr Type type_of{sizeof(T), std::is_floating_point_v<T>, [](const char* bytes) {
                         T value;
                         std::memcpy(&value, bytes, sizeof value);
                         return static_cast<double>(value);
                       }};

Type find_type(std::string_view name) {
  if (name == "char" || name == "int8") return type_of<std::int8_t>;
  if (name == "uchar" || name == "uint8") return type_of<std::uint8_t>;
  if (name == "short" || name == "int16") return type_of<std::int16_t>;
  if (name == "ushort" || name == "uint16") return type_of<std::uint16_t>;
  if (name == "int" || name == "int32") return type_of<std::int32_t>;
  if (name == "uint" || name == "uint32") return type_of<std::uint32_t>;
  if (name == "float" || name == "float32") return type_of<float>;
  if (name == "double" || name == "float64") return type_of<double>;
  damaged("PLY: unknown type " + in_quotes(name));
}

struct Property {
  bool is_list = false;
  bool has_corners = false;  // a list of the vertices of a face
  Type count_type{};         // of a list
  Type type{};
  std::string name;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
};

Property parse_property(std::string_view line) {
  Property property;
  std::string_view type = take_word(line);
  property.is_list = type == "list";
  if (property.is_list) {
    property.count_type = find_type(take_word(line));
    type = take_word(line);
  }
  property.type = find_type(type);
  property.name = take_word(line);
  if (property.name.empty() || !take_word(line).empty())
    damaged("PLY: a property line is not a type and a name");
  property.has_corners =
      property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
  if (property.count_type.is_real || (property.has_corners && property.type.is_real))
    damaged("PLY: counts or indices of " + in_quotes(property.name) + " are no integers");
  return property;
}

Element parse_element(std::string_view line) {
  Element element;
  element.name = take_word(line);
  const auto count = parse_number<std::uint64_t>(take_word(line));
  if (!count) damaged("PLY: element " + in_quotes(element.name) + " has no count");
  element.count = *count;
  return element;
}

Header take_header(std::string_view& rest) {
  Header header;
  if (take_line(rest) != "ply") damaged("PLY: the first line is not 'ply'");
  for (;;) {
    if (rest.empty()) damaged("PLY: the header has no 'end_header'");
    std::string_view line = take_line(rest);
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") return header;
    if (keyword == "format") header.format = take_word(line);
    if (keyword == "element") header.elements.push_back(parse_element(line));
    if (keyword != "property") continue;
    if (header.elements.empty()) damaged("PLY: a property comes before any element");
    header.elements.back().properties.push_back(parse_property(line));
  }
}

/// Returns which property of a vertex is x, y or z.
std::size_t find_coordinate(const Element& vertex, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < vertex.properties.size(); ++i)
    if (vertex.properties[i].name == name && !vertex.properties[i].is_list) found.push_back(i);
  if (found.size() != 1)
    throw FormatError("PLY: its vertices have " + std::to_string(found.size()) + " properties '" +
                      name + "'; export it with one x, one y and one z");
  return found.front();
}

/// Reads the elements of the body in order, text or binary.
class PlyReader {
 public:
  PlyReader(std::string_view body, const std::string& format)
      : rest_(body), text_(format == "ascii"), swap_(format == "binary_big_endian") {
    if (!text_ && !swap_ && format != "binary_little_endian")
      damaged("PLY: unknown format " + in_quotes(format));
  }

  void read(const Element& element) {
    const std::string name = "PLY: element " + in_quotes(element.name);
    if (element.properties.empty() && element.count > 0) damaged(name + " has no properties");
    for (const Property& property : element.properties)
      if (property.has_corners && element.name != "face")
        throw FormatError(name + " has a surface that is not supported; export triangles");
    if (element.name == "vertex")
      read_vertices(element);
    else
      for (std::uint64_t i = 0; i < element.count; ++i) read_row(element);
  }

  TriangleMesh finish() {
    // A last line without an end may lack digits.
    if (text_ && rest_.empty()) damaged("PLY: the last line has no end");
    if (text_ ? !take_word(rest_).empty() : !rest_.empty())
      damaged("PLY: it has more data than its header counts");
    return std::move(mesh_);
  }

 private:
  void read_vertices(const Element& element) {
    if (!mesh_.vertices.empty()) damaged("PLY: two elements are named 'vertex'");
    const std::size_t x = find_coordinate(element, "x");
    const std::size_t y = find_coordinate(element, "y");
    const std::size_t z = find_coordinate(element, "z");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element);
      mesh_.vertices.push_back(Eigen::Vector3d(row_[x], row_[y], row_[z]).cast<float>());
    }
  }

  void read_row(const Element& element) {
    row_.clear();
    for (const Property& property : element.properties)
      row_.push_back(property.is_list ? read_list(property) : number(property.type));
  }

  /// Returns the count.
  double read_list(const Property& property) {
    const double count = number(property.count_type);
    if (!(count >= 0.0 && count == std::trunc(count)))
      damaged("PLY: a list's count is negative or not an integer");
    corners_.clear();
    for (double i = 0.0; i < count; ++i) {
      const double value = number(property.type);
      if (property.has_corners)
        corners_.push_back(vertex_index(value, mesh_.vertices.size(), "PLY"));
    }
    append_polygon(corners_, mesh_);
    return count;
  }

  double number(const Type& type) {
    const std::string_view word = text_ ? take_word(rest_) : rest_.substr(0, type.size);
    if (text_ ? word.empty() : word.size() < type.size)
      damaged("PLY: it has less data than its header counts");
    if (text_) {
      const auto value = parse_number<double>(word);
      if (!value) damaged("PLY: " + in_quotes(word) + " is no number");
      return *value;
    }
    rest_.remove_prefix(type.size);
    std::array<char, 8> raw{};
    std::copy(word.begin(), word.end(), raw.begin());
    if (swap_) std::reverse(raw.data(), raw.data() + type.size);
    return type.read(raw.data());
  }

  std::string_view rest_;
  bool text_;
  bool swap_;
  std::vector<double> row_;             // of an element
  std::vector<std::uint32_t> corners_;  // of a face
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes) {
  const Header header = take_header(bytes);
  PlyReader reader(bytes, header.format);
  for (const Element& element : header.elements) reader.read(element);
  return reader.finish();
}

}  // namespace penumbra::mesh_formats
