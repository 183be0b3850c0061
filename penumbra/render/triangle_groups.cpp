// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/triangle_groups.hpp>

namespace penumbra {

std::vector<TriangleGroup> groups_of(const PreparedMesh& mesh) {
  std::array<TriangleGroup, 3> kinds;
  auto& [closed, perforated, open] = kinds;
  closed.solid = perforated.solid = true;
  for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
    const SurfacePatch& patch = mesh.patches[i];
    const auto& [facing, holes] = mesh.orientations()[i];
    TriangleGroup& group = facing == Facing::unknown ? open : holes.empty() ? closed : perforated;
    // A patch that faces inwards is turned: what is first seen of it from outside is then a front
    // face, even if it is a cavity inside another body.
    const bool turn = facing == Facing::inwards;
    for (const std::uint32_t t : patch.triangles) {
      auto [a, b, c] = mesh.triangles[t];
      if (turn) std::swap(b, c);
      group.indices.insert(group.indices.end(), {a, b, c});
    }
    group.bounds.extend(patch.bounds);
    group.holes.insert(group.holes.end(), holes.begin(), holes.end());
  }
  std::vector<TriangleGroup> groups;
  for (TriangleGroup& group : kinds) {
    if (!group.indices.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

SideRule::SideRule(const Intrinsics& k) {
  const double u = std::max(std::abs(k.cx()), std::abs(k.width() - k.cx())) / k.fx();
  const double v = std::max(std::abs(k.cy()), std::abs(k.height() - k.cy())) / k.fy();
  constexpr double rounding = 1e-6;  // metres
  reach_ = DepthRenderer::near_plane * std::sqrt(1.0 + u * u + v * v) + rounding;
}

Sides SideRule::sides(bool solid, bool has_holes, const Eigen::AlignedBox3d& bounds,
                      const Eigen::Vector3d& camera_centre) const {
  if (!solid || bounds.exteriorDistance(camera_centre) <= reach_) return Sides::both;
  return has_holes ? Sides::front_and_through_holes : Sides::front;
}

}  // namespace penumbra
