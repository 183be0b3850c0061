// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include <meshoptimizer.h>

#include <penumbra/mesh/simplified.hpp>

namespace penumbra {

TriangleMesh simplified(TriangleMesh mesh, double error) {
  if (mesh.triangles.empty()) return mesh;
  const std::size_t stride = sizeof(Eigen::Vector3f);
  const float* const positions = mesh.vertices.front().data();
  std::uint32_t* const corners = mesh.triangles.front().data();
  const float scale = meshopt_simplifyScale(positions, mesh.vertices.size(), stride);
  const std::size_t count =
      meshopt_simplify(corners, corners, 3 * mesh.triangles.size(), positions, mesh.vertices.size(),
                       stride, 0, static_cast<float>(error) / scale);
  mesh.triangles.resize(count / 3);
  return mesh;
}

}  // namespace penumbra
