// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

/// A ball in the mesh's frame, metres.
struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

/// Triangles of a mesh that are connected by regular edges. Exactly two triangles share a regular
/// edge, in opposite directions, so a patch has two distinct sides.
struct SurfacePatch {
  std::vector<std::uint32_t> triangles;  ///< indices into TriangleMesh::triangles, rising
  Eigen::AlignedBox3d bounds;            ///< metres
  double rim = 0.0;                      ///< length of the other edges, metres

  [[nodiscard]] bool closed() const { return rim == 0.0; }
  /// Returns a radius that no hole exceeds: a closed line fits into a ball of a quarter its length.
  [[nodiscard]] double hole_radius() const { return rim / 4.0; }
};

/// Where the front faces of a surface patch point. Known if the patch bounds a body, except for
/// holes whose radii add up to an eighth of its size at most. A ray from outside then meets the
/// outer side of a closed patch first. (Tested at five or more points of the patch. A patch that
/// crosses itself may pass if it shows its back on less than about a hundredth of its area.)
enum class Facing { unknown, outwards, inwards };

/// A mesh that is ready for every renderer and check. Its vertices are welded. Immutable.
class PreparedMesh : public TriangleMesh {
 public:
  /// Indices must be in range and coordinates finite.
  explicit PreparedMesh(const TriangleMesh& mesh);

  std::vector<SurfacePatch> patches;  ///< ordered by their first triangle
  Eigen::AlignedBox3d bounds;         ///< metres; empty if there are no triangles
  bool watertight = false;            ///< there are triangles, and every patch is closed

  /// Returns the facing of every patch. The first call finds them for all copies of the mesh, which
  /// may take a second for large meshes.
  [[nodiscard]] const std::vector<Facing>& facings() const;

  /// The same for all copies of a mesh, and for no other mesh while any holder of it lives. What is
  /// made of a mesh is kept by it.
  [[nodiscard]] std::shared_ptr<const void> identity() const { return facings_; }

 private:
  struct Facings;
  std::shared_ptr<Facings> facings_;
};

}  // namespace penumbra
