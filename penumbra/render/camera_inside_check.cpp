// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;

/// Solid angle of a triangle seen from the origin, with its sign (van Oosterom and Strackee 1983).
double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// A closed piece of a body's surface.
struct Shell {
  TriangleMesh mesh;
  Eigen::AlignedBox3d bounds;

  [[nodiscard]] bool holds(const Vector3d& point) const {
    if (!bounds.contains(point)) return false;
    double angle = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
      angle += solid_angle(mesh.vertices[a].cast<double>() - point,
                           mesh.vertices[b].cast<double>() - point,
                           mesh.vertices[c].cast<double>() - point);
    }
    return std::abs(angle) > 2.0 * std::numbers::pi;  // 4 pi inside, 0 outside
  }
};

std::vector<Shell> closed_shells(const TriangleMesh& mesh) {
  const TriangleMesh welded = weld(mesh);
  std::vector<Shell> shells;
  for (const MeshComponent& component : connected_components(welded)) {
    if (!component.closed) continue;
    Shell& shell = shells.emplace_back();
    shell.mesh.vertices = welded.vertices;
    for (const std::size_t t : component.triangles) {
      shell.mesh.triangles.push_back(welded.triangles[t]);
      for (const auto i : welded.triangles[t]) {
        shell.bounds.extend(welded.vertices[i].cast<double>());
      }
    }
  }
  return shells;
}

}  // namespace

struct CameraInsideCheck::Solid {
  std::vector<Shell> shells;
  Vector3d last_centre = Vector3d::Constant(std::nan(""));
  bool last_answer = false;

  [[nodiscard]] bool holds(const Vector3d& centre) {
    constexpr double same = 1e-7;  // metres: a camera fixed to a link moves by rounding alone
    if (!((centre - last_centre).cwiseAbs().maxCoeff() <= same)) {
      last_centre = centre;
      last_answer = false;
      for (const Shell& shell : shells) last_answer = last_answer || shell.holds(centre);
    }
    return last_answer;
  }
};

CameraInsideCheck::CameraInsideCheck(std::span<const Body> bodies) {
  for (const Body& body : bodies) {
    Solid& solid = solids_.emplace_back();
    for (const TriangleMesh& mesh : body.meshes) {
      for (Shell& shell : closed_shells(mesh)) solid.shells.push_back(std::move(shell));
    }
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
