// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>
#include <penumbra/robot/triangle_tree-inl.hpp>

namespace penumbra::offset {

/// Distances from a surface, metres.
struct DepthBounds {
  double depth;
  double least;
  double most;
};

/// Whether a mesh's middles of sides and faces lie within the bounds from a surface.
[[nodiscard]] bool keeps_depth(const TriangleMesh& mesh, const TriangleTree& surface,
                               const DepthBounds& bounds);

/// Splits the sides of a closed mesh where it does not, and moves the new corners to the depth.
/// False where that does not do.
[[nodiscard]] bool refine_to_depth(TriangleMesh& mesh, const TriangleTree& surface,
                                   const DepthBounds& bounds);

}  // namespace penumbra::offset
