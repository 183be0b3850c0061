// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <pybind11/stl/filesystem.h>
#include <python/values.hpp>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::python {

using VertexArray = Shown<"Annotated[NDArray[float32], '(N, 3)']">;
using TriangleArray = Shown<"Annotated[NDArray[uint32], '(M, 3)']">;

/// A mesh of Python's, and what keeps it.
struct Mesh {
  std::shared_ptr<const PreparedMesh> prepared;
};

/// A rigid thing to draw, with its meshes.
struct OwnedBody {
  std::string name;
  std::vector<Mesh> meshes;
};

/// Returns make(bodies) for bodies of Python.
template <typename Make>
auto with_bodies(const std::vector<OwnedBody>& owned, const Make& make) {
  std::vector<std::vector<PreparedMesh>> meshes;
  for (const OwnedBody& body : owned) {
    auto& of_body = meshes.emplace_back();
    for (const Mesh& mesh : body.meshes) of_body.push_back(*mesh.prepared);
  }
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < owned.size(); ++i) bodies.push_back({owned[i].name, meshes[i]});
  return make(std::span<const Body>(bodies));
}

/// A robot as an argument: a Robot, or the path of a URDF.
struct RobotArgument {
  std::variant<std::filesystem::path, Robot> given;
  /// Throws InputError for a file that cannot be read.
  [[nodiscard]] Robot robot() const {
    const auto* const path = std::get_if<std::filesystem::path>(&given);
    return path != nullptr ? Robot::load(*path) : std::get<Robot>(given);
  }
};

/// Returns the message of a KeyError for an unknown variable.
[[nodiscard]] std::string no_variable(const Robot& robot, const std::string& name);

}  // namespace penumbra::python

namespace pybind11::detail {

template <>
struct type_caster<penumbra::python::RobotArgument>
    : penumbra::python::ValueCaster<penumbra::python::RobotArgument> {
  using Path = make_caster<std::filesystem::path>;
  static constexpr auto name = const_name("Union[penumbra.Robot, ") + Path::name + const_name("]");
  bool load(handle source, bool convert) {
    if (isinstance<penumbra::Robot>(source)) {
      value.given = source.cast<const penumbra::Robot&>();
      return true;
    }
    Path path;
    if (!path.load(source, convert)) return false;
    value.given = cast_op<std::filesystem::path&>(path);
    return true;
  }
};

}  // namespace pybind11::detail
