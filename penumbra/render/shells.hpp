// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/intrinsics.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// The triangles of a mesh that share one answer to "may back faces be skipped?".
struct ShellTriangles {
  /// They bound bodies and are wound outwards: from outside, back faces are only seen through the
  /// holes.
  bool solid = false;
  Eigen::AlignedBox3d bounds{};        ///< in the mesh's frame
  std::vector<Ball> holes;             ///< of the solid; empty where it is closed
  std::vector<std::uint32_t> indices;  ///< of the mesh's vertices, three for each triangle
};

/// Returns all triangles of a mesh: those of closed patches, of patches with small holes and of
/// open patches, in this order. Empty shells are left out.
[[nodiscard]] std::vector<ShellTriangles> shells_of(const PreparedMesh& mesh);

/// Which sides of a shell's triangles can be seen; backs through holes only where those are.
enum class Sides : std::uint8_t { front, front_and_through_holes, both };

/// Tells for one camera which sides of shells can be seen.
class SideRule {
 public:
  explicit SideRule(const Intrinsics& intrinsics);

  /// Backs are seen of an open shell, of a solid one through its holes, and of one that the near
  /// plane may cut open or that may hold the camera. `bounds` and the camera's centre are in the
  /// body's frame.
  [[nodiscard]] Sides sides(bool solid, bool pierced, const Eigen::AlignedBox3d& bounds,
                            const Eigen::Vector3d& camera_centre) const;

 private:
  double reach_;  // metres: no point of the near plane inside the image is farther away
};

}  // namespace penumbra
