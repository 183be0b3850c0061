// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// The triangles of a mesh with the same rule for back faces.
struct TriangleGroup {
  /// They bound bodies and are wound outwards: from outside, back faces are only visible through
  /// holes.
  bool solid = false;
  Eigen::AlignedBox3d bounds{};        ///< in the mesh's frame
  std::vector<Ball> holes;             ///< of the solid; empty if it is closed
  std::vector<std::uint32_t> indices;  ///< of the mesh's vertices, three per triangle
};

/// Returns all triangles of a mesh in up to three groups: closed patches, patches with small holes,
/// and open patches. Omits empty groups.
[[nodiscard]] std::vector<TriangleGroup> groups_of(const PreparedMesh& mesh);

/// The visible sides of a group's triangles.
enum class Sides : std::uint8_t { front, front_and_through_holes, both };

/// Decides which sides of groups are visible to a camera.
class SideRule {
 public:
  explicit SideRule(const Intrinsics& intrinsics);

  /// Back faces are visible if the group is open, if the near plane may cut it or the camera may be
  /// inside it, and otherwise only through holes. `bounds` and the camera's centre are in the
  /// body's frame.
  [[nodiscard]] Sides sides(bool solid, bool has_holes, const Eigen::AlignedBox3d& bounds,
                            const Eigen::Vector3d& camera_centre) const;

 private:
  double reach_;  // metres: no point of the near plane inside the image is farther away
};

}  // namespace penumbra
