// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::test {

/// Returns the volume of closed meshes, cubic metres; positive if they are wound outwards.
inline double signed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0.0;
  const Vector3d eye = mesh.vertices.front().cast<double>();
  const auto at = [&](std::uint32_t i) -> Vector3d {
    return mesh.vertices[i].cast<double>() - eye;
  };
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) sum += at(a).dot(at(b).cross(at(c)));
  return sum / 6.0;
}

}  // namespace penumbra::test
