// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/mesh_collada-inl.hpp>
#include <penumbra/mesh/mesh_formats-inl.hpp>
#include <penumbra/mesh/mesh_text-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

using collada::damaged_at;
using collada::fail;
using collada::required;
using detail::XmlElement;

constexpr double largest_unit = 1e6;  // metres
constexpr int most_nodes = 1'000'000;
constexpr int deepest_node = 100;

/// The numbers of a transform's text, all of them and no more.
std::vector<double> parameters_of(const XmlElement& element, std::size_t count) {
  std::vector<double> numbers = collada::numbers_of(element);
  if (numbers.size() != count)
    damaged_at(element, "it has " + std::to_string(numbers.size()) + " of " +
                            std::to_string(count) + " numbers");
  for (const double number : numbers)
    if (!std::isfinite(number)) damaged_at(element, "a number is not finite");
  return numbers;
}

Eigen::Affine3d read_rotation(const XmlElement& element) {
  const auto n = parameters_of(element, 4);
  const Eigen::Vector3d axis(n[0], n[1], n[2]);
  if (n[3] == 0.0) return Eigen::Affine3d::Identity();
  if (axis.norm() < 1e-9) damaged_at(element, "its axis has no direction");
  return Eigen::Affine3d(Eigen::AngleAxisd(n[3] * std::numbers::pi / 180.0, axis.normalized()));
}

Eigen::Affine3d read_matrix(const XmlElement& element) {
  const auto n = parameters_of(element, 16);
  constexpr double rounding = 1e-6;  // of a product that an exporter made
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > rounding)
    damaged_at(element, "its last row is not 0 0 0 1");
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.matrix().topRows<3>() = matrix.topRows<3>();
  return transform;
}

bool is_transform(const XmlElement& element) {
  return element.name == "translate" || element.name == "rotate" || element.name == "scale" ||
         element.name == "matrix";
}

/// Cameras and lights often hang on them; geometry seldom does.
bool is_unread_transform(const XmlElement& element) {
  return element.name == "lookat" || element.name == "skew";
}

Eigen::Affine3d read_transform(const XmlElement& element) {
  if (element.name == "matrix") return read_matrix(element);
  if (element.name == "rotate") return read_rotation(element);
  const auto n = parameters_of(element, 3);
  const Eigen::Vector3d v(n[0], n[1], n[2]);
  return element.name == "scale" ? Eigen::Affine3d(Eigen::Scaling(v))
                                 : Eigen::Affine3d(Eigen::Translation3d(v));
}

/// Elements by the id that links name. Two of a kind may share one as long as nothing names it.
class Index {
 public:
  void add(const XmlElement& element) {
    if (const std::string* const id = element.attribute("id")) elements_.emplace(*id, &element);
  }

  [[nodiscard]] const XmlElement& find(const XmlElement& link) const {
    const std::string id = collada::reference(link, "url");
    const auto [begin, end] = elements_.equal_range(id);
    if (begin == end)
      fail(link, "it refers to '#" + id.substr(0, 80) +
                     "', which is not in the file; export everything into one file");
    if (std::next(begin) != end)
      damaged_at(link, "two elements have the id '" + id.substr(0, 80) + "'");
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
    const XmlElement& scene = scenes_.find(
        collada::only_child(collada::only_child(root, "scene"), "instance_visual_scene"));
    visit(scene, {Eigen::Affine3d(Eigen::Scaling(unit_))}, 0);
    if (!shows_geometry_)
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
        fail(child, "meter=\"" + text->substr(0, 40) +
                        "\" is no length; write how many metres the unit has");
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
    const XmlElement* unread = nullptr;  // a transform that is not in it
  };

  /// Transforms come before the children that they move, by the schema; they hold for all of them.
  void visit(const XmlElement& node, Pose pose, int depth) {
    if (depth > deepest_node) damaged_at(node, "nodes contain each other");
    if (++visited_ > most_nodes) damaged_at(node, "nodes unfold to more than a million");
    for (const XmlElement& child : node.children) {
      if (is_transform(child)) pose.T_file_node = pose.T_file_node * read_transform(child);
      if (is_unread_transform(child)) pose.unread = &child;
    }
    for (const XmlElement& child : node.children) show(node, child, pose, depth);
  }

  void show(const XmlElement& node, const XmlElement& child, const Pose& pose, int depth) {
    static const std::set<std::string, std::less<>> without_surface = {
        "instance_camera", "instance_light", "extra", "asset", "evaluate_scene"};
    if (child.name == "node")
      visit(child, pose, depth + 1);
    else if (child.name == "instance_node")
      visit(nodes_.find(child), pose, depth + 1);
    else if (child.name == "instance_controller")
      fail(child, "a mesh that joints bend is not read; export it as it stands, without its skin");
    else if (child.name == "instance_geometry")
      append(geometries_.find(child), pose);
    else if (!is_transform(child) && !is_unread_transform(child) &&
             without_surface.count(child.name) == 0)
      damaged_at(child, "it stands in <" + node.name + ">");
  }

  void append(const XmlElement& geometry, const Pose& pose) {
    if (pose.unread != nullptr)
      fail(*pose.unread, "it moves geometry, and is not read; export it as a <matrix>");
    shows_geometry_ = true;
    const auto [at, is_new] = meshes_.try_emplace(&geometry);
    if (is_new) at->second = collada::read_geometry(geometry);
    append_placed(at->second, pose.T_file_node, out_);
  }

  double unit_ = 1.0;  // metres
  Index geometries_;
  Index nodes_;
  Index scenes_;
  std::map<const XmlElement*, TriangleMesh> meshes_;
  int visited_ = 0;
  bool shows_geometry_ = false;
  TriangleMesh out_;
};

XmlElement read_document(std::string_view bytes) {
  std::string_view start = bytes.substr(bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  if (!take_word(start).starts_with('<') || bytes.find('\0') != std::string_view::npos)
    damaged("Collada: it is no XML text in UTF-8");
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
