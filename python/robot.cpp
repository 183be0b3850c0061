// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <optional>

#include <python/arrays.hpp>
#include <python/bindings.hpp>
#include <python/fields.hpp>
#include <python/robot.hpp>

#include <penumbra/pipeline/link_points.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::python {
namespace {

/// An array of rows of three numbers, as it must lie in memory.
template <typename T>
py::array rows_of_three(const py::object& source, const char* argument) {
  const std::string type = py::cast<std::string>(py::str(py::dtype::of<T>()));
  const std::string expected = std::string(argument) + ": expected numpy.ndarray of " + type +
                               " with shape (N, 3) in C order; got " + description_of(source);
  if (!py::isinstance<py::array>(source)) throw py::type_error(expected);
  if (is_masked(source)) throw py::type_error(expected + mask_fault);
  py::array array(source);
  if (!is_native(array.dtype(), py::dtype::of<T>().num())) throw py::type_error(expected);
  if (array.ndim() != 2 || array.shape(1) != 3 || (array.flags() & py::array::c_style) == 0)
    throw py::value_error(expected);
  return array;
}

Mesh mesh_of(const VertexArray& given_vertices, const TriangleArray& given_triangles) {
  const py::array vertices = rows_of_three<float>(given_vertices, "vertices");
  const py::array triangles = rows_of_three<std::uint32_t>(given_triangles, "triangles");
  TriangleMesh mesh;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  mesh.vertices.resize(static_cast<std::size_t>(vertices.shape(0)));
  mesh.triangles.resize(static_cast<std::size_t>(triangles.shape(0)));
  if (vertices.nbytes() > 0)
    std::memcpy(mesh.vertices[0].data(), vertices.data(),
                static_cast<std::size_t>(vertices.nbytes()));
  if (triangles.nbytes() > 0)
    std::memcpy(mesh.triangles[0].data(), triangles.data(),
                static_cast<std::size_t>(triangles.nbytes()));
  for (const auto& vertex : mesh.vertices)
    if (!vertex.allFinite()) throw py::value_error("vertices: expected finite numbers");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= mesh.vertices.size())
        throw py::value_error("triangles: expected indices below the number of vertices, " +
                              std::to_string(mesh.vertices.size()) + "; got " +
                              std::to_string(corner));
  return {std::make_shared<const PreparedMesh>(mesh)};
}

/// A read-only view of rows of three numbers in a mesh.
template <typename Result, auto Rows>
Result rows_array(const Mesh& mesh) {
  const auto& rows = (*mesh.prepared).*Rows;
  using T = std::remove_cvref_t<decltype(rows[0][0])>;
  return read_only(py::array(py::dtype::of<T>(),
                             {static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}}, {},
                             rows.data(), keeper_of(mesh.prepared)));
}

void bind_mesh(py::module_& m) {
  py::class_<Mesh> mesh(m, "TriangleMesh",
                        "Triangles over shared vertices, metres. Seen from outside, corners run "
                        "counter-clockwise.");
  mesh.def(py::init(&mesh_of), py::arg("vertices"), py::arg("triangles"),
           "vertices: float32 (N, 3), metres; triangles: uint32 (M, 3), indices of vertices. The "
           "mesh keeps a copy, in which equal vertices are one.");
  show_properties(mesh,
                  Field{"vertices", &rows_array<VertexArray, &TriangleMesh::vertices>,
                        "float32 (N, 3), metres. Read-only view."},
                  Field{"triangles", &rows_array<TriangleArray, &TriangleMesh::triangles>,
                        "uint32 (M, 3), indices of vertices. Read-only view."});
  mesh.def("__repr__", [](const Mesh& of) {
    return "<penumbra.TriangleMesh: " + std::to_string(of.prepared->triangles.size()) +
           " triangles>";
  });
  py::class_<OwnedBody> body(m, "Body", "A rigid thing to draw.");
  bind_fields<2>(body, Field{"name", &OwnedBody::name, "Its name."},
                 Field{"meshes", &OwnedBody::meshes, "In the body's frame; may be empty."});
}

void bind_options(py::module_& m) {
  py::class_<ExtraMesh> extra(m, "ExtraMesh",
                              "What a link carries that the URDF lacks: a tool, a cable, a cover.");
  bind_fields(extra, Field{"link", &ExtraMesh::link, "Its name; no pattern."},
              Field{"mesh", &ExtraMesh::mesh, "A file, in the link's frame, metres."});
  py::class_<RobotOptions> options(m, "RobotOptions",
                                   "What of a URDF or MJCF is drawn, and where its files are. Link "
                                   "patterns are globs (*, ?, [a-z]).");
  using O = RobotOptions;
  bind_fields(
      options, Field{"packages", &O::packages, "package://NAME to its folder."},
      Field{"arguments", &O::arguments, "Of a xacro file: name to value."},
      Field{"geometry", &O::geometry,
            "Which geometry is drawn; None: collision, and visual for links that have no other."},
      Field{"geometry_of_links", &O::geometry_of_links, "By pattern, in place of geometry."},
      Field{"geometry_fallback", &O::geometry_fallback,
            "Take the other geometry for a link that lacks the chosen one, without a note."},
      Field{"ignore_links", &O::ignore_links, "Patterns of links that are not drawn."},
      Field{"joints", &O::joints,
            "Joint to the position at which it is held, rad or m: it does not move."},
      Field{"only_links", &O::only_links, "If not empty: patterns of the links drawn."},
      Field{"margins", &O::margins, "By pattern: surface offset, metres, -1 to 1."},
      Field{"extra", &O::extra, "Drawn with their links, whatever else is drawn of them."},
      Field{"allow_missing_meshes", &O::allow_missing_meshes,
            "Go on without meshes that cannot be read: their links are missing, in every report."});
}

void bind_robot_parts(py::module_& m) {
  using L = LinkReport;
  py::class_<L> link(m, "LinkReport", "What became of a link's geometry.");
  show_fields(
      link, Field{"link", &L::link, "Its name."}, Field{"drawn", &L::drawn, "Whether it is drawn."},
      Field{"missing", &L::missing, "It should be drawn and is not."},
      Field{"fault", &L::fault, "Of a mesh that could not be read; else empty."},
      Field{"reason", &L::reason, "Why it is not drawn, or what was chosen."},
      Field{"sources", &L::sources, "Each element's file or primitive."},
      Field{"triangles", &L::triangles, "How many."},
      Field{"watertight", &L::watertight, "Every mesh of the link is closed, before margins."},
      Field{"margin", &L::margin, "Metres."}, Field{"load_ms", &L::load_ms, "Milliseconds."});
  using J = Joint;
  py::class_<J> joint(m, "Joint",
                      "A joint of the tree. Its frame is the child link's at position 0.");
  show_fields(joint, Field{"name", &J::name, "Its name."}, Field{"type", &J::type, "Its type."},
              Field{"parent", &J::parent, "Link index."}, Field{"child", &J::child, "Link index."},
              Field{"origin", &J::origin, "T_parent_joint, metres."},
              Field{"axis", &J::axis, "Unit, in the joint's frame."},
              Field{"velocity", &J::velocity, "Limit, rad/s or m/s; None: none."},
              Field{"lower", &J::lower, "Limit, rad or m; None: none."},
              Field{"upper", &J::upper, "Limit, rad or m; None: none."},
              Field{"variable", &J::variable,
                    "First of its values in the position vector; None of a fixed joint."},
              Field{"multiplier", &J::multiplier, "Of a mimicking joint."},
              Field{"offset", &J::offset, "Of a mimicking joint, rad or m."},
              Field{"mimics", &J::mimics, "Whether it follows another joint."});
}

/// Meshes are kept by the robot that they are of.
std::vector<Mesh> meshes_of(const Robot& robot, std::size_t link) {
  if (link >= robot.links().size())
    throw py::index_error("link: expected an index below " + std::to_string(robot.links().size()) +
                          "; got " + std::to_string(link));
  const auto keeper = std::make_shared<const Robot>(robot);
  std::vector<Mesh> meshes;
  for (const PreparedMesh& mesh : robot.meshes(link)) {
    meshes.push_back({std::shared_ptr<const PreparedMesh>(keeper, &mesh)});
  }
  return meshes;
}

std::vector<OwnedBody> bodies_of(const Robot& robot) {
  std::vector<OwnedBody> bodies;
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    bodies.push_back({robot.links()[i], meshes_of(robot, i)});
  return bodies;
}

Poses link_poses(const Robot& robot, const Numbers& positions) {
  if (positions.size() != robot.variables().size())
    throw py::value_error("positions: expected shape (" + std::to_string(robot.variables().size()) +
                          ",), in the order of Robot.variables; got " +
                          std::to_string(positions.size()) + " numbers");
  Poses poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  return poses;
}

std::size_t find_variable(const Robot& robot, const std::string& name) {
  const auto index = robot.find_variable(name);
  if (!index) throw py::key_error(no_variable(robot, name));
  return *index;
}

void bind_robot_class(py::module_& m) {
  using R = Robot;
  py::class_<R> robot(m, "Robot",
                      "Links, joints and geometry of a URDF, xacro or MJCF. Immutable.");
  robot
      .def_static("load", &Robot::load, py::arg("urdf"), py::arg("options") = RobotOptions(),
                  WithoutGil(),
                  "Reads a URDF, xacro or MJCF and its meshes. Raises InputError with file, line "
                  "and element.")
      .def_static(
          "parse",
          [](const std::string& xml, const std::filesystem::path& folder,
             const RobotOptions& options) { return Robot::parse(xml, folder, options); },
          py::arg("xml"), py::arg("folder"), py::arg("options") = RobotOptions(), WithoutGil(),
          "The same from text; relative mesh paths start at folder.")
      .def_static(
          "join",
          [](const std::vector<std::tuple<std::string, Robot, Eigen::Isometry3d>>& robots) {
            std::vector<PlacedRobot> placed;
            for (const auto& [name, one, T_world_root] : robots)
              placed.push_back({name, one, T_world_root});
            return Robot::join(placed);
          },
          py::arg("robots"),
          "Joins several robots to one. robots: (name, robot, T_world_root in metres) of each. The "
          "root link is 'world'; NAME of robot ROBOT is called ROBOT/NAME. Raises InputError.")
      .def("find_link", &Robot::find_link, py::arg("name"), "Its index, or None.")
      .def("find_variable", &find_variable, py::arg("name"),
           "Its index. Raises KeyError for an unknown name.")
      .def(
          "rest_positions", [](const Robot& r) { return r.rest_positions(); },
          "Positions of every variable at rest: 0, and the unit quaternion. A read-only array.")
      .def(
          "meshes", [](const Robot& r, std::size_t i) { return Frozen<Mesh>{meshes_of(r, i)}; },
          py::arg("link"), "Of link i, in its frame; empty if it is not drawn.")
      .def("points_on", &points_on, py::arg("link"), py::arg("count"), WithoutGil(),
           "Points of a link's drawn surface, spread evenly by area, in the link's frame, metres: "
           "float64 (count, 3), the same at each call. Raises InputError for an unknown link and "
           "one that is not drawn.")
      .def("forward_kinematics", &link_poses, py::arg("positions"),
           "T_root_link of every link, metres. positions: in the order of variables, rad and m. "
           "Raises ValueError for another number of them, and for what is not finite.")
      .def("__repr__", [](const Robot& r) {
        return "<penumbra.Robot '" + r.name() + "': " + std::to_string(r.links().size()) +
               " links, " + std::to_string(r.variables().size()) + " variables>";
      });
  show_properties(
      robot, Field{"name", &R::name, "The name in its description."},
      Field{"urdf",
            [](const R& r) { return r.urdf().empty() ? std::nullopt : std::optional(r.urdf()); },
            "The file that load() read; None: it comes from none (parse(), join(), a bag)."},
      Field{"options", &R::options, "As given to load() or parse()."},
      Field{"links", &R::links, "Names, parents before children; index 0 is the root."},
      Field{"joints", &R::joints, "joints[i].child == i + 1."},
      Field{"variables", &R::variables, "Names of the position values, in their order."},
      Field{"report", &R::report, "What became of each link's geometry."},
      Field{"notes", &R::notes, "What is doubtful though nothing is wrong, a line each."},
      Field{"bodies", &bodies_of, "The links with their meshes, to draw."});
}

}  // namespace

std::string no_variable(const Robot& robot, const std::string& name) {
  std::string message = "'" + name + "' is no variable of robot '" + robot.name() + "'; it has";
  for (const std::string& variable : robot.variables()) message += " " + variable;
  return message;
}

void bind_robot(py::module_& m) {
  bind_mesh(m);
  bind_options(m);
  bind_robot_parts(m);
  bind_robot_class(m);
}

}  // namespace penumbra::python
