// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::python {

inline bool is_any(const PyObject* object) { return object != nullptr; }

class VertexArray : public pybind11::object {
  PYBIND11_OBJECT_DEFAULT(VertexArray, pybind11::object, is_any)
};
class TriangleArray : public pybind11::object {
  PYBIND11_OBJECT_DEFAULT(TriangleArray, pybind11::object, is_any)
};

/// A mesh of Python's, and what keeps it.
struct Mesh {
  std::shared_ptr<const TriangleMesh> triangles;
  std::shared_ptr<const PreparedMesh> prepared{};  // the same one; null if Python made the mesh
};

/// A rigid thing to draw, with its meshes.
struct OwnedBody {
  std::string name;
  std::vector<Mesh> meshes;
};

/// Returns the message of a KeyError for an unknown variable.
[[nodiscard]] std::string no_variable(const Robot& robot, const std::string& name);

}  // namespace penumbra::python

namespace pybind11::detail {

template <>
struct handle_type_name<penumbra::python::VertexArray> {
  static constexpr auto name = const_name("Annotated[NDArray[float32], '(N, 3)']");
};
template <>
struct handle_type_name<penumbra::python::TriangleArray> {
  static constexpr auto name = const_name("Annotated[NDArray[uint32], '(M, 3)']");
};

}  // namespace pybind11::detail
