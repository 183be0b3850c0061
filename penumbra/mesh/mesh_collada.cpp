// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <penumbra/base/error.hpp>
#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/mesh/mesh_formats.hpp>

namespace penumbra::mesh_formats {
namespace {

using detail::XmlElement;
using Names = std::set<std::string, std::less<>>;

constexpr double largest_unit = 1e6;  // metres
constexpr int most_nodes = 1'000'000;
constexpr int deepest_node = 100;

/// Throws FormatError that names line and element; `what` ends with a remedy after a semicolon.
[[noreturn]] void fail(const XmlElement& element, const std::string& what) {
  throw FormatError("Collada, line " + std::to_string(element.line) + ", <" +
                    element.name.substr(0, 40) + ">: " + what);
}

[[noreturn]] void damaged_at(const XmlElement& element, const std::string& what) {
  fail(element, what + "; the file is damaged: export or copy it again");
}

const std::string& required(const XmlElement& element, std::string_view name) {
  const std::string* const value = element.attribute(name);
  if (value == nullptr) damaged_at(element, "it has no " + std::string(name));
  return *value;
}

/// Returns the id that an attribute such as url="#id" names; links to other files are refused.
std::string reference(const XmlElement& element, std::string_view name) {
  const std::string& url = required(element, name);
  if (!url.starts_with('#'))
    fail(element, "it refers to " + in_quotes(url) +
                      ", which is not in the file; export everything into one file");
  return url.substr(1);
}

std::uint64_t required_count(const XmlElement& element, std::string_view name) {
  const std::string& text = required(element, name);
  const auto value = parse_number<std::uint32_t>(text);
  if (!value) damaged_at(element, std::string(name) + "=" + in_quotes(text) + " is not an integer");
  return *value;
}

std::uint64_t count_or(const XmlElement& element, std::string_view name, std::uint64_t absent) {
  return element.attribute(name) == nullptr ? absent : required_count(element, name);
}

/// Returns the only child with a name and, if given, an attribute of that value.
const XmlElement& only_child(const XmlElement& parent, std::string_view name,
                             std::string_view attribute = {}, std::string_view value = {}) {
  const std::string what = "<" + std::string(name) + "> " + std::string(value.substr(0, 80));
  const XmlElement* found = nullptr;
  for (const XmlElement& child : parent.children) {
    if (child.name != name || (!attribute.empty() && required(child, attribute) != value)) continue;
    if (found != nullptr) damaged_at(child, "a second " + what + " in <" + parent.name + ">");
    found = &child;
  }
  if (found == nullptr) damaged_at(parent, "it has no " + what);
  return *found;
}

template <typename Number>
std::vector<Number> numbers_of(const XmlElement& element) {
  std::vector<Number> numbers;
  std::string_view text = element.text;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    const auto value = parse_number<Number>(word);
    if (!value) damaged_at(element, in_quotes(word) + " is no number");
    numbers.push_back(*value);
  }
  return numbers;
}

/// Returns the positions of a <source>, whose params must be X, Y and Z, in this order.
std::vector<Eigen::Vector3f> read_positions(const XmlElement& source) {
  const XmlElement& array = only_child(source, "float_array");
  const XmlElement& accessor = only_child(only_child(source, "technique_common"), "accessor");
  if (reference(accessor, "source") != required(array, "id"))
    damaged_at(accessor, "its source is not the <float_array> of its <source>");
  std::string params;
  for (const XmlElement& param : accessor.children) {
    const std::string* const name = param.attribute("name");
    params += (name == nullptr ? "" : *name) + ' ';
  }
  if (!params.starts_with("X Y Z ")) damaged_at(accessor, "positions need the params X, Y and Z");
  const std::vector<double> values = numbers_of<double>(array);
  const std::uint64_t count = required_count(accessor, "count");
  const std::uint64_t stride = count_or(accessor, "stride", 1);
  const std::uint64_t offset = count_or(accessor, "offset", 0);
  if (stride < 3) damaged_at(accessor, "its params exceed its stride of " + std::to_string(stride));
  if (values.size() != required_count(array, "count") || offset + count * stride > values.size())
    damaged_at(array, "its count of numbers and those of its <accessor> disagree");
  std::vector<Eigen::Vector3f> positions(count);
  for (std::size_t i = 0; i < count; ++i)
    positions[i] = Eigen::Vector3d(&values[offset + i * stride]).cast<float>();
  return positions;
}

/// Reads the triangles of a <mesh>, in the file's unit.
class MeshReader {
 public:
  explicit MeshReader(const XmlElement& mesh)
      : mesh_(mesh), vertices_(only_child(mesh, "vertices")) {
    const XmlElement& input = only_child(vertices_, "input", "semantic", "POSITION");
    out_.vertices = read_positions(only_child(mesh, "source", "id", reference(input, "source")));
  }

  TriangleMesh read() {
    static const Names without_surface = {"source",     "vertices", "lines",
                                          "linestrips", "extra",    "asset"};
    static const Names surfaces = {"triangles", "polylist", "polygons", "tristrips", "trifans"};
    for (const XmlElement& child : mesh_.children) {
      if (surfaces.contains(child.name))
        read_surface(child);
      else if (!without_surface.contains(child.name))
        damaged_at(child, "it is unknown in a <mesh>");
    }
    return std::move(out_);
  }

 private:
  using Corners = std::vector<std::uint32_t>;

  void read_surface(const XmlElement& element) {
    std::vector<Corners> lists;  // of each <p>
    const bool has_list = std::any_of(
        element.children.begin(), element.children.end(),
        [](const XmlElement& child) { return child.name == "p" || child.name == "ph"; });
    const Layout layout = has_list ? layout_of(element) : Layout{};
    for (const XmlElement& child : element.children)
      if (child.name == "p") lists.push_back(corners_of(child, layout));
    const bool has_one_list = element.name == "triangles" || element.name == "polylist";
    if (lists.size() > 1 && has_one_list) damaged_at(element, "it has a second <p>");
    std::uint64_t found = 0;  // triangles or polygons, as its count says
    for (const Corners& corners : lists)
      found += element.name == "polylist" ? add_polygons(element, corners)
                                          : add_list(element.name, corners);
    const std::uint64_t count = required_count(element, "count");
    if (found != count)
      damaged_at(element, "its count promises " + std::to_string(count) + " primitives, it has " +
                              std::to_string(found));
  }

  /// Returns how many primitives of the element's kind it added.
  std::uint64_t add_list(const std::string& kind, const Corners& corners) {
    if (kind == "polygons") {
      append_polygon(corners, out_);
      return 1;
    }
    const bool is_list = kind == "triangles";
    if (is_list && corners.size() % 3 != 0)
      damaged("Collada: " + std::to_string(corners.size()) + " corners are no whole triangles");
    for (std::size_t i = 2; i < corners.size(); i += is_list ? 3 : 1) {
      if (kind == "tristrips")
        out_.triangles.push_back({corners[i - 2], corners[i - 1 + i % 2], corners[i - i % 2]});
      else
        out_.triangles.push_back({corners[is_list ? i - 2 : 0], corners[i - 1], corners[i]});
    }
    return is_list ? corners.size() / 3 : 1;
  }

  std::uint64_t add_polygons(const XmlElement& element, const Corners& corners) {
    const auto sizes = numbers_of<std::uint32_t>(only_child(element, "vcount"));
    std::span<const std::uint32_t> rest = corners;
    for (const std::size_t size : sizes) {
      if (size > rest.size()) damaged_at(element, "its <vcount> and its <p> disagree");
      append_polygon(rest.first(size), out_);
      rest = rest.subspan(size);
    }
    if (!rest.empty()) damaged_at(element, "its <vcount> and its <p> disagree");
    return sizes.size();
  }

  /// The indices of a corner in <p>: how many there are, and which one is the vertex's.
  struct Layout {
    std::size_t stride = 1;
    std::size_t vertex = 0;
  };

  [[nodiscard]] Layout layout_of(const XmlElement& element) const {
    static const Names known = {"input", "p", "vcount", "extra"};
    constexpr std::uint64_t most_inputs = 64;
    const XmlElement& vertex = only_child(element, "input", "semantic", "VERTEX");
    if (reference(vertex, "source") != required(vertices_, "id"))
      damaged_at(vertex, "its source is not the <vertices> of its mesh");
    Layout layout;
    for (const XmlElement& child : element.children) {
      if (child.name == "ph")
        fail(child, "a polygon with a hole is not supported; export the mesh as triangles");
      if (!known.contains(child.name)) damaged_at(child, "it is unknown in <" + element.name + ">");
      if (child.name != "input") continue;
      const std::uint64_t offset = count_or(child, "offset", 0);
      if (offset >= most_inputs) damaged_at(child, "its offset is above 63");
      layout.stride = std::max<std::size_t>(layout.stride, offset + 1);
      if (&child == &vertex) layout.vertex = offset;
    }
    return layout;
  }

  [[nodiscard]] Corners corners_of(const XmlElement& p, const Layout& layout) const {
    const auto indices = numbers_of<std::int64_t>(p);
    if (indices.size() % layout.stride != 0)
      damaged_at(p, "its " + std::to_string(indices.size()) + " indices are no multiple of " +
                        std::to_string(layout.stride));
    Corners corners;
    corners.reserve(indices.size() / layout.stride);
    const std::string where = "Collada, line " + std::to_string(p.line);
    for (std::size_t i = layout.vertex; i < indices.size(); i += layout.stride)
      corners.push_back(vertex_index(indices[i], out_.vertices.size(), where));
    return corners;
  }

  const XmlElement& mesh_;
  const XmlElement& vertices_;
  TriangleMesh out_;
};

/// Returns the `count` numbers of a transform.
std::vector<double> parameters_of(const XmlElement& element, std::size_t count) {
  std::vector<double> numbers = numbers_of<double>(element);
  const bool is_finite = std::all_of(numbers.begin(), numbers.end(),
                                     [](double number) { return std::isfinite(number); });
  if (numbers.size() != count || !is_finite)
    damaged_at(element, "it needs " + std::to_string(count) + " finite numbers");
  return numbers;
}

bool is_transform(const XmlElement& element) {
  return element.name == "translate" || element.name == "rotate" || element.name == "scale" ||
         element.name == "matrix";
}

/// Exporters use them for cameras and lights.
bool is_unsupported_transform(const XmlElement& element) {
  return element.name == "lookat" || element.name == "skew";
}

Eigen::Affine3d read_transform(const XmlElement& element) {
  if (element.name == "matrix") {
    const auto n = parameters_of(element, 16);
    Eigen::Affine3d transform;
    transform.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
    constexpr double rounding = 1e-6;  // of the exporter's products
    if (!transform.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), rounding))
      damaged_at(element, "its last row is not 0 0 0 1");
    transform.makeAffine();
    return transform;
  }
  if (element.name == "rotate") {
    const auto n = parameters_of(element, 4);
    const Eigen::Vector3d axis(n[0], n[1], n[2]);
    if (n[3] == 0.0) return Eigen::Affine3d::Identity();
    if (axis.norm() < 1e-9) damaged_at(element, "its axis has no direction");
    return Eigen::Affine3d(Eigen::AngleAxisd(n[3] * std::numbers::pi / 180.0, axis.normalized()));
  }
  const Eigen::Vector3d v(parameters_of(element, 3).data());
  return element.name == "scale" ? Eigen::Affine3d(Eigen::Scaling(v))
                                 : Eigen::Affine3d(Eigen::Translation3d(v));
}

/// Elements by id. Two may share an id as long as no link names it.
class Index {
 public:
  void add(const XmlElement& element) {
    if (const std::string* const id = element.attribute("id")) elements_.emplace(*id, &element);
  }

  [[nodiscard]] const XmlElement& find(const XmlElement& link) const {
    const std::string id = reference(link, "url");
    const auto [begin, end] = elements_.equal_range(id);
    if (begin == end)
      fail(link, "it refers to " + in_quotes("#" + id) +
                     ", which is not in the file; export everything into one file");
    if (std::next(begin) != end) damaged_at(link, "two elements have the id " + in_quotes(id));
    return *begin->second;
  }

 private:
  std::multimap<std::string, const XmlElement*> elements_;
};

class SceneReader {
 public:
  explicit SceneReader(const XmlElement& root) {
    for (const XmlElement& library : root.children) {
      if (library.name == "asset") read_asset(library);
      if (library.name == "library_geometries")
        for (const XmlElement& child : library.children) geometries_.add(child);
      if (library.name == "library_nodes") add_nodes(library);
      if (library.name != "library_visual_scenes") continue;
      for (const XmlElement& child : library.children) scenes_.add(child);
      for (const XmlElement& child : library.children) add_nodes(child);
    }
  }

  TriangleMesh read(const XmlElement& root) {
    const XmlElement& scene =
        scenes_.find(only_child(only_child(root, "scene"), "instance_visual_scene"));
    visit(scene, {Eigen::Affine3d(Eigen::Scaling(unit_))}, 0);
    if (meshes_.empty())
      throw FormatError("Collada: its scene shows no geometry; export the mesh as part of a scene");
    return std::move(out_);
  }

 private:
  void read_asset(const XmlElement& asset) {
    for (const XmlElement& child : asset.children) {
      const std::string* const text = child.attribute("meter");
      if (child.name != "unit" || text == nullptr) continue;
      const auto metres = parse_number<double>(*text);
      if (!metres || !(*metres > 0.0 && *metres <= largest_unit))
        fail(child, "meter=" + in_quotes(*text) + " is no length; write the unit in metres");
      unit_ = *metres;
    }
  }

  void add_nodes(const XmlElement& parent) {
    for (const XmlElement& child : parent.children) {
      if (child.name != "node") continue;
      nodes_.add(child);
      add_nodes(child);
    }
  }

  struct Pose {
    Eigen::Affine3d T_file_node;
    const XmlElement* unsupported = nullptr;  // a transform that it lacks
  };

  void visit(const XmlElement& node, Pose pose, int depth) {
    if (depth > deepest_node) damaged_at(node, "nodes contain each other");
    if (++visited_ > most_nodes) damaged_at(node, "nodes unfold to more than a million");
    for (const XmlElement& child : node.children) {
      if (is_transform(child)) pose.T_file_node = pose.T_file_node * read_transform(child);
      if (is_unsupported_transform(child)) pose.unsupported = &child;
    }
    for (const XmlElement& child : node.children) show(node, child, pose, depth);
  }

  void show(const XmlElement& node, const XmlElement& child, const Pose& pose, int depth) {
    static const Names without_surface = {"instance_camera", "instance_light", "extra", "asset",
                                          "evaluate_scene"};
    if (child.name == "node")
      visit(child, pose, depth + 1);
    else if (child.name == "instance_node")
      visit(nodes_.find(child), pose, depth + 1);
    else if (child.name == "instance_controller")
      fail(child, "a mesh with a skin is not supported; export it without the skin");
    else if (child.name == "instance_geometry")
      append(geometries_.find(child), pose);
    else if (!is_transform(child) && !is_unsupported_transform(child) &&
             !without_surface.contains(child.name))
      damaged_at(child, "it is unknown in <" + node.name + ">");
  }

  void append(const XmlElement& geometry, const Pose& pose) {
    if (pose.unsupported != nullptr)
      fail(*pose.unsupported, "it moves geometry; export it as a <matrix>");
    const auto [at, is_new] = meshes_.try_emplace(&geometry);
    if (is_new) at->second = MeshReader(only_child(geometry, "mesh")).read();
    append_placed(at->second, pose.T_file_node, out_);
  }

  double unit_ = 1.0;  // metres
  Index geometries_;
  Index nodes_;
  Index scenes_;
  std::map<const XmlElement*, TriangleMesh> meshes_;
  int visited_ = 0;
  TriangleMesh out_;
};

XmlElement read_document(std::string_view bytes) {
  try {
    return detail::read_xml(bytes, "Collada");
  } catch (const InputError& error) {
    damaged(error.what());
  }
}

}  // namespace

TriangleMesh read_collada(std::string_view bytes) {
  const XmlElement root = read_document(bytes);
  if (root.name != "COLLADA")
    throw FormatError("Collada: the root element is <" + root.name.substr(0, 40) +
                      ">; a Collada file has <COLLADA>");
  return SceneReader(root).read(root);
}

}  // namespace penumbra::mesh_formats
