// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace penumbra {

/// Triangles over shared vertices, metres. Seen from outside, corners run counter-clockwise.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

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
  bool closed = false;                   ///< all of its edges are regular
};

/// Where the front faces of a surface patch point.
enum class Facing { unknown, outwards, inwards };

/// The outer side of a surface patch.
struct PatchOrientation {
  /// Known if the patch bounds a body except for small holes. A ray from outside then meets the
  /// outer side of the patch first, unless it passed through the ball of a hole or meets a triangle
  /// that touches such a ball. (Tested at four or more points of the patch. A patch that crosses
  /// itself may pass if it shows its back on less than about a hundredth of its area.)
  Facing facing = Facing::unknown;

  /// Balls around the holes; empty if the patch is closed or `facing` is unknown. The sum of their
  /// radii is at most an eighth of the patch's size.
  std::vector<Ball> holes;
};

/// A mesh that is ready for every renderer and check. Its vertices are welded. Immutable.
class PreparedMesh : public TriangleMesh {
 public:
  /// Indices must be in range and coordinates finite.
  explicit PreparedMesh(const TriangleMesh& mesh);

  std::vector<SurfacePatch> patches;  ///< ordered by their first triangle
  Eigen::AlignedBox3d bounds;         ///< metres; empty if there are no triangles
  bool watertight = false;            ///< there are triangles, and every patch is closed

  /// Returns the orientation of every patch. The first call computes them for all copies of the
  /// mesh, which may take a second for large meshes.
  [[nodiscard]] const std::vector<PatchOrientation>& orientations() const;

  /// The same for all copies of a mesh, and for no other mesh while any holder of it lives. What is
  /// made of a mesh is kept by it.
  [[nodiscard]] std::shared_ptr<const void> identity() const { return orientations_; }

 private:
  struct Orientations;
  std::shared_ptr<Orientations> orientations_;
};

}  // namespace penumbra
