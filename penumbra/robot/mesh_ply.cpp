// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include <penumbra/robot/mesh_formats-inl.hpp>
#include <penumbra/robot/mesh_text-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

struct Property {
  bool is_list = false;
  std::string count_type;  // of a list
  std::string type;
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

std::size_t size_of(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "double" || type == "float64") return 8;
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32") return 4;
  if (type == "float" || type == "float32") return 4;
  damaged("PLY: unknown type '" + type.substr(0, 40) + "'");
}

bool is_real(const std::string& type) { return type.starts_with("float") || type == "double"; }

bool is_signed(const std::string& type) { return type.front() != 'u'; }

Property parse_property(std::string_view line) {
  Property property;
  property.type = take_word(line);
  if (property.type == "list") {
    property.is_list = true;
    property.count_type = take_word(line);
    property.type = take_word(line);
    if (is_real(property.count_type))
      damaged("PLY: a list is counted in '" + property.count_type + "'");
    size_of(property.count_type);
  }
  size_of(property.type);
  property.name = take_word(line);
  if (property.name.empty() || !take_word(line).empty())
    damaged("PLY: a property line is not of a type and a name");
  return property;
}

Element parse_element(std::string_view line) {
  Element element;
  element.name = take_word(line);
  const auto count = parse_number<std::uint64_t>(take_word(line));
  if (!count) damaged("PLY: element '" + element.name.substr(0, 40) + "' has no count");
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
    if (header.elements.empty()) damaged("PLY: a property stands before any element");
    header.elements.back().properties.push_back(parse_property(line));
  }
}

/// Values of the body, one after the other, text or binary.
class Body {
 public:
  Body(std::string_view rest, const std::string& format)
      : rest_(rest), text_(format == "ascii"), swap_(format == "binary_big_endian") {
    if (!text_ && !swap_ && format != "binary_little_endian")
      damaged("PLY: unknown format '" + format.substr(0, 40) + "'");
  }

  std::int64_t integer(const std::string& type) {
    if (text_) return static_cast<std::int64_t>(number());
    if (is_real(type)) damaged("PLY: an index is of type '" + type + "'");
    const std::size_t size = size_of(type);
    const std::string_view raw = take(size);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto byte = static_cast<unsigned char>(raw[swap_ ? i : size - 1 - i]);
      value = value << 8 | byte;
    }
    const auto unused = static_cast<int>(64 - 8 * size);
    return is_signed(type) ? static_cast<std::int64_t>(value << unused) >> unused
                           : static_cast<std::int64_t>(value);
  }

  void skip(const std::string& type) {
    if (text_)
      number();
    else
      take(size_of(type));
  }

  void finish() const {
    std::string_view rest = rest_;
    // A last line without its end may lack digits: nothing else would show it.
    if (text_ && rest.empty()) damaged("PLY: the last line has no end");
    if (text_ ? !take_word(rest).empty() : !rest.empty())
      damaged("PLY: data follow behind those that the header counts");
  }

 private:
  double number() {
    const std::string_view word = take_word(rest_);
    const auto value = parse_number<double>(word);
    if (word.empty()) damaged("PLY: the data end before the counts of the header are reached");
    if (!value) damaged("PLY: '" + std::string(word.substr(0, 40)) + "' is no number");
    constexpr double within_int64 = 1e18;
    return std::clamp(*value, -within_int64, within_int64);
  }

  std::string_view take(std::size_t size) {
    if (rest_.size() < size)
      damaged("PLY: the data end before the counts of the header are reached");
    const std::string_view raw = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return raw;
  }

  std::string_view rest_;
  bool text_;
  bool swap_;
};

void check_list(Body& body, const Property& property, std::uint64_t vertices) {
  const std::int64_t count = body.integer(property.count_type);
  const bool names_vertices = property.name == "vertex_indices" || property.name == "vertex_index";
  if (count < 0) damaged("PLY: a list has a negative count");
  if (names_vertices) check_corners(static_cast<std::uint64_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    if (!names_vertices) {
      body.skip(property.type);
      continue;
    }
    const std::int64_t index = body.integer(property.type);
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
      damaged("PLY: a face names vertex " + std::to_string(index) + " of " +
              std::to_string(vertices));
  }
}

/// Assimp takes 0 for a coordinate that is not there.
void check_coordinates(const Element& vertex) {
  for (const char* name : {"x", "y", "z"}) {
    const auto count = std::count_if(
        vertex.properties.begin(), vertex.properties.end(),
        [&](const Property& property) { return property.name == name && !property.is_list; });
    if (count != 1)
      throw FormatError("PLY: its vertices have " + std::to_string(count) + " properties '" + name +
                        "'; x, y and z are wanted, once each: export it again");
  }
}

}  // namespace

void check_ply(std::string_view bytes) {
  const Header header = take_header(bytes);
  std::uint64_t vertices = 0;
  for (const Element& element : header.elements) {
    if (element.name != "vertex") continue;
    check_coordinates(element);
    vertices = element.count;
  }

  Body body(bytes, header.format);
  for (const Element& element : header.elements) {
    if (element.properties.empty() && element.count > 0)
      damaged("PLY: element '" + element.name.substr(0, 40) + "' has no properties");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (property.is_list)
          check_list(body, property, vertices);
        else
          body.skip(property.type);
      }
    }
  }
  body.finish();
}

}  // namespace penumbra::mesh_formats
