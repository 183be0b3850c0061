// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <penumbra/render/depth_renderer.hpp>
#include <penumbra/render/shells.hpp>

namespace penumbra {

std::vector<ShellTriangles> shells_of(const TriangleMesh& welded) {
  std::array<ShellTriangles, 3> kinds;
  auto& [closed, pierced, open] = kinds;
  closed.solid = pierced.solid = true;
  for (const MeshSheet& sheet : mesh_sheets(welded)) {
    const bool solid = sheet.facing != Facing::unknown;
    ShellTriangles& shell = !solid ? open : sheet.holes.empty() ? closed : pierced;
    // A solid sheet that is wound inwards is turned: what is first seen of it from outside is then
    // a front face, also where it is a cavity inside another.
    const bool turn = solid && sheet.facing == Facing::inwards;
    for (const std::size_t t : sheet.triangles) {
      auto [a, b, c] = welded.triangles[t];
      if (turn) std::swap(b, c);
      shell.indices.insert(shell.indices.end(), {a, b, c});
    }
    if (solid) shell.holes.insert(shell.holes.end(), sheet.holes.begin(), sheet.holes.end());
  }
  std::vector<ShellTriangles> shells;
  for (ShellTriangles& shell : kinds) {
    if (!shell.indices.empty()) shells.push_back(std::move(shell));
  }
  return shells;
}

SideRule::SideRule(const Intrinsics& k) {
  const double u = std::max(std::abs(k.cx()), std::abs(k.width() - k.cx())) / k.fx();
  const double v = std::max(std::abs(k.cy()), std::abs(k.height() - k.cy())) / k.fy();
  constexpr double rounding = 1e-6;  // metres
  reach_ = DepthRenderer::near_plane * std::sqrt(1.0 + u * u + v * v) + rounding;
}

Sides SideRule::sides(bool solid, bool pierced, const Eigen::AlignedBox3d& bounds,
                      const Eigen::Vector3d& camera_centre) const {
  if (!solid || bounds.exteriorDistance(camera_centre) <= reach_) return Sides::both;
  return pierced ? Sides::front_and_through_holes : Sides::front;
}

}  // namespace penumbra
