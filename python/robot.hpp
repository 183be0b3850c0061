// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <python/values.hpp>

#include <penumbra/mesh/prepared_mesh.hpp>
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

/// Returns the message of a KeyError for an unknown variable.
[[nodiscard]] std::string no_variable(const Robot& robot, const std::string& name);

}  // namespace penumbra::python
