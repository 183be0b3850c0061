// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

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

/// Returns the message of a KeyError for an unknown variable.
[[nodiscard]] std::string no_variable(const Robot& robot, const std::string& name);

}  // namespace penumbra::python
