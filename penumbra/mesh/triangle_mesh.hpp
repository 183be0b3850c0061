// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace penumbra {

/// Triangles over shared vertices, metres. Seen from outside, corners run counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace penumbra
