// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <penumbra/base/mesh_sheets.hpp>
#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/base/solid_angle-inl.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
using Eigen::Vector3d;

struct CameraInsideCheck::Solid {
  /// A piece of the body's surface that bounds it but for small holes.
  struct Boundary {
    std::vector<std::array<Eigen::Vector3f, 3>> triangles;
    Eigen::AlignedBox3d bounds;

    [[nodiscard]] bool holds(const Vector3d& point) const {
      if (!bounds.contains(point)) return false;
      double angle = 0.0;
      for (const auto& [a, b, c] : triangles) {
        angle += solid_angle({a.cast<double>(), b.cast<double>(), c.cast<double>()}, point);
      }
      // Inside 4 pi, outside 0, less or more by what the holes take up.
      return std::abs(angle) > 2.0 * std::numbers::pi;
    }
  };

  std::vector<Boundary> boundaries;
  Vector3d last_centre = Vector3d::Constant(std::nan(""));
  bool last_answer = false;

  void add(const TriangleMesh& mesh) {
    const TriangleMesh welded = weld(mesh);
    for (const MeshSheet& sheet : mesh_sheets(welded)) {
      if (!sheet.closed && sheet.facing == Facing::unknown) continue;
      auto& [triangles, bounds] = boundaries.emplace_back();
      triangles.reserve(sheet.triangles.size());
      for (const std::size_t t : sheet.triangles) {
        const auto& [a, b, c] = welded.triangles[t];
        triangles.push_back({welded.vertices[a], welded.vertices[b], welded.vertices[c]});
        for (const Eigen::Vector3f& p : triangles.back()) bounds.extend(p.cast<double>());
      }
    }
  }

  [[nodiscard]] bool holds(const Vector3d& centre) {
    constexpr double same = 1e-7;  // metres: a camera fixed to a link moves by rounding alone
    if (!((centre - last_centre).cwiseAbs().maxCoeff() <= same)) {
      last_centre = centre;
      last_answer = std::any_of(boundaries.begin(), boundaries.end(),
                                [&](const Boundary& b) { return b.holds(centre); });
    }
    return last_answer;
  }
};

CameraInsideCheck::CameraInsideCheck(std::span<const Body> bodies) {
  for (const Body& body : bodies) {
    Solid& solid = solids_.emplace_back();
    for (const TriangleMesh& mesh : body.meshes) solid.add(mesh);
  }
}

CameraInsideCheck::~CameraInsideCheck() = default;

std::optional<std::size_t> CameraInsideCheck::find(
    std::span<const Eigen::Isometry3d> T_camera_body) {
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    const Eigen::Isometry3d& T = T_camera_body[i];
    if (solids_[i].holds(-(T.linear().transpose() * T.translation()))) return i;
  }
  return std::nullopt;
}

}  // namespace penumbra
