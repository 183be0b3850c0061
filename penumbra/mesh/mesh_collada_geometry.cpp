// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

#include <penumbra/mesh/mesh_collada-inl.hpp>
#include <penumbra/mesh/mesh_formats-inl.hpp>
#include <penumbra/mesh/mesh_polygon-inl.hpp>
#include <penumbra/mesh/mesh_text-inl.hpp>

namespace penumbra::mesh_formats::collada {

void fail(const XmlElement& element, const std::string& what) {
  throw FormatError("Collada, line " + std::to_string(element.line) + ", <" +
                    element.name.substr(0, 40) + ">: " + what);
}

void damaged_at(const XmlElement& element, const std::string& what) {
  fail(element, what + "; the file is damaged: export or copy it again");
}

const std::string& required(const XmlElement& element, std::string_view name) {
  const std::string* const value = element.attribute(name);
  if (value == nullptr) damaged_at(element, "it has no " + std::string(name));
  return *value;
}

std::string reference(const XmlElement& element, std::string_view name) {
  const std::string& url = required(element, name);
  if (!url.starts_with('#'))
    fail(element, "it refers to '" + url.substr(0, 80) +
                      "', which is not in the file; export everything into one file");
  return url.substr(1);
}

std::uint64_t count_of(const XmlElement& element, std::string_view name,
                       std::optional<std::uint64_t> otherwise) {
  const std::string* const text = element.attribute(name);
  if (text == nullptr && otherwise) return *otherwise;
  const auto value = parse_number<std::uint32_t>(required(element, name));
  if (!value)
    damaged_at(element, std::string(name) + "=\"" + text->substr(0, 40) + "\" is no whole number");
  return *value;
}

const XmlElement& only_child(const XmlElement& parent, std::string_view name) {
  const XmlElement* found = nullptr;
  for (const XmlElement& child : parent.children) {
    if (child.name != name) continue;
    if (found != nullptr) damaged_at(child, "a second one in <" + parent.name + ">");
    found = &child;
  }
  if (found == nullptr) damaged_at(parent, "it has no <" + std::string(name) + ">");
  return *found;
}

namespace {

template <typename Number>
std::vector<Number> parse_all(const XmlElement& element) {
  std::vector<Number> numbers;
  std::string_view text = element.text;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    const auto value = parse_number<Number>(word);
    if (!value) damaged_at(element, "'" + std::string(word.substr(0, 40)) + "' is no number");
    numbers.push_back(*value);
  }
  return numbers;
}

/// The only <input> of a semantic.
const XmlElement& only_input(const XmlElement& parent, std::string_view semantic) {
  const XmlElement* found = nullptr;
  for (const XmlElement& child : parent.children) {
    if (child.name != "input" || required(child, "semantic") != semantic) continue;
    if (found != nullptr) damaged_at(child, "a second " + std::string(semantic));
    found = &child;
  }
  if (found == nullptr) damaged_at(parent, "it has no <input> of " + std::string(semantic));
  return *found;
}

/// Exporters write X, Y and Z first in each stride.
void check_params(const XmlElement& accessor) {
  constexpr std::array<std::string_view, 3> axes = {"X", "Y", "Z"};
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (i >= accessor.children.size() || required(accessor.children[i], "name") != axes[i])
      damaged_at(accessor, "positions need the params X, Y and Z, in this order");
}

/// The positions of a <source>.
std::vector<Eigen::Vector3f> read_positions(const XmlElement& source) {
  const XmlElement& array = only_child(source, "float_array");
  const std::vector<double> values = numbers_of(array);
  if (values.size() != count_of(array, "count"))
    damaged_at(array, "it promises " + required(array, "count") + " numbers and has " +
                          std::to_string(values.size()));
  const XmlElement& accessor = only_child(only_child(source, "technique_common"), "accessor");
  if (reference(accessor, "source") != required(array, "id"))
    damaged_at(accessor, "its source is not the <float_array> beside it");
  check_params(accessor);
  const std::uint64_t count = count_of(accessor, "count");
  const std::uint64_t stride = count_of(accessor, "stride", 1);
  const std::uint64_t offset = count_of(accessor, "offset", 0);
  if (stride < 3)
    damaged_at(accessor, "its params reach beyond its stride of " + std::to_string(stride));
  if (offset + count * stride > values.size())
    damaged_at(accessor, "it reads " + std::to_string(offset + count * stride) + " of " +
                             std::to_string(values.size()) + " numbers");
  std::vector<Eigen::Vector3f> positions(count);
  for (std::size_t i = 0; i < count; ++i)
    positions[i] = Eigen::Vector3d(&values[offset + i * stride]).cast<float>();
  return positions;
}

/// Turns the primitives of a <mesh> into triangles.
class MeshReader {
 public:
  explicit MeshReader(const XmlElement& mesh)
      : mesh_(mesh), vertices_(only_child(mesh, "vertices")) {
    const XmlElement& input = only_input(vertices_, "POSITION");
    const std::string id = reference(input, "source");
    const XmlElement* source = nullptr;
    for (const XmlElement& child : mesh.children) {
      const std::string* const name = child.attribute("id");
      if (child.name != "source" || name == nullptr || *name != id) continue;
      if (source != nullptr) damaged_at(child, "a second one of id '" + id.substr(0, 80) + "'");
      source = &child;
    }
    if (source == nullptr)
      damaged_at(input, "no <source> of its mesh has the id '" + id.substr(0, 80) + "'");
    out_.vertices = read_positions(*source);
  }

  TriangleMesh read() {
    static const std::set<std::string, std::less<>> without_surface = {
        "source", "vertices", "lines", "linestrips", "extra", "asset"};
    static const std::map<std::string, void (MeshReader::*)(const XmlElement&), std::less<>>
        surfaces = {{"triangles", &MeshReader::triangles},
                    {"polylist", &MeshReader::polylist},
                    {"polygons", &MeshReader::polygons},
                    {"tristrips", &MeshReader::strips},
                    {"trifans", &MeshReader::fans}};
    for (const XmlElement& child : mesh_.children) {
      const auto surface = surfaces.find(child.name);
      if (surface != surfaces.end())
        (this->*surface->second)(child);
      else if (without_surface.count(child.name) == 0)
        damaged_at(child, "it stands in a <mesh>");
    }
    return std::move(out_);
  }

 private:
  void triangles(const XmlElement& element) {
    const std::uint64_t count = count_of(element, "count");
    const std::vector<std::uint32_t> corners = corners_of_only_p(element);
    expect(element, "corners", 3 * count, corners.size());
    for (std::size_t i = 0; i < corners.size(); i += 3)
      out_.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }

  void polylist(const XmlElement& element) {
    const std::vector<std::uint32_t> corners = corners_of_only_p(element);
    std::vector<std::int64_t> sizes;
    if (!corners.empty()) sizes = integers_of(only_child(element, "vcount"));
    expect(element, "polygons", count_of(element, "count"), sizes.size());
    std::span<const std::uint32_t> rest = corners;
    for (const std::int64_t size : sizes) {
      if (size < 0 || static_cast<std::uint64_t>(size) > rest.size())
        damaged_at(element, "its vcount and its <p> do not agree");
      append_polygon(rest.first(static_cast<std::size_t>(size)), out_);
      rest = rest.subspan(static_cast<std::size_t>(size));
    }
    if (!rest.empty()) damaged_at(element, "its vcount and its <p> do not agree");
  }

  void polygons(const XmlElement& element) {
    for (const auto& corners : corners_of_each_p(element)) append_polygon(corners, out_);
  }

  void strips(const XmlElement& element) {
    for (const auto& corners : corners_of_each_p(element))
      for (std::size_t i = 2; i < corners.size(); ++i)
        out_.triangles.push_back({corners[i - 2], corners[i - 1 + i % 2], corners[i - i % 2]});
  }

  void fans(const XmlElement& element) {
    for (const auto& corners : corners_of_each_p(element))
      for (std::size_t i = 2; i < corners.size(); ++i)
        out_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }

  static void expect(const XmlElement& element, const char* what, std::uint64_t promised,
                     std::uint64_t found) {
    if (promised != found)
      damaged_at(element, "its count promises " + std::to_string(promised) + " " + what +
                              ", it has " + std::to_string(found));
  }

  /// The indices of a corner in <p>: how many, and which is the vertex's.
  struct Layout {
    std::size_t stride = 1;
    std::size_t vertex = 0;
  };

  [[nodiscard]] Layout layout_of(const XmlElement& element) const {
    static const std::set<std::string, std::less<>> known = {"input", "p", "vcount", "extra"};
    constexpr std::uint64_t most_inputs = 64;
    const XmlElement& vertex = only_input(element, "VERTEX");
    if (reference(vertex, "source") != required(vertices_, "id"))
      damaged_at(vertex, "its source is not the <vertices> of its mesh");
    const auto is_input = [](const XmlElement& child) { return child.name == "input"; };
    const bool is_alone =
        std::count_if(element.children.begin(), element.children.end(), is_input) == 1;
    Layout layout;
    for (const XmlElement& child : element.children) {
      if (child.name == "ph")
        fail(child, "a polygon with a hole is not read; export the mesh as triangles");
      if (known.count(child.name) == 0) damaged_at(child, "it stands in <" + element.name + ">");
      if (!is_input(child)) continue;
      const std::uint64_t offset =
          is_alone ? count_of(child, "offset", 0) : count_of(child, "offset");
      if (offset >= most_inputs)
        damaged_at(child, "its offset is beyond " + std::to_string(most_inputs));
      layout.stride = std::max<std::size_t>(layout.stride, offset + 1);
      if (&child == &vertex) layout.vertex = offset;
    }
    return layout;
  }

  [[nodiscard]] std::vector<std::uint32_t> corners_of(const XmlElement& p,
                                                      const Layout& layout) const {
    const std::vector<std::int64_t> indices = integers_of(p);
    if (indices.size() % layout.stride != 0)
      damaged_at(p, std::to_string(indices.size()) + " indices are no multiple of " +
                        std::to_string(layout.stride));
    std::vector<std::uint32_t> corners;
    corners.reserve(indices.size() / layout.stride);
    for (std::size_t i = layout.vertex; i < indices.size(); i += layout.stride) {
      if (indices[i] < 0 || static_cast<std::uint64_t>(indices[i]) >= out_.vertices.size())
        damaged_at(p, "a face names vertex " + std::to_string(indices[i]) + " of " +
                          std::to_string(out_.vertices.size()));
      corners.push_back(static_cast<std::uint32_t>(indices[i]));
    }
    return corners;
  }

  /// For each <p>, of which `count` tells the number.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> corners_of_each_p(
      const XmlElement& element) const {
    const Layout layout = layout_of(element);
    std::vector<std::vector<std::uint32_t>> all;
    for (const XmlElement& child : element.children)
      if (child.name == "p") all.push_back(corners_of(child, layout));
    expect(element, "<p>", count_of(element, "count"), all.size());
    return all;
  }

  /// None where `count` is 0, as exporters write for a material that no face has.
  [[nodiscard]] std::vector<std::uint32_t> corners_of_only_p(const XmlElement& element) const {
    const auto is_p = [](const XmlElement& child) { return child.name == "p"; };
    if (count_of(element, "count") == 0 &&
        std::none_of(element.children.begin(), element.children.end(), is_p))
      return {};
    return corners_of(only_child(element, "p"), layout_of(element));
  }

  const XmlElement& mesh_;
  const XmlElement& vertices_;
  TriangleMesh out_;
};

}  // namespace

std::vector<double> numbers_of(const XmlElement& element) { return parse_all<double>(element); }

std::vector<std::int64_t> integers_of(const XmlElement& element) {
  return parse_all<std::int64_t>(element);
}

TriangleMesh read_geometry(const XmlElement& geometry) {
  return MeshReader(only_child(geometry, "mesh")).read();
}

}  // namespace penumbra::mesh_formats::collada
