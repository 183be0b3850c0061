// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <penumbra/mesh/mesh_sheets.hpp>
#include <penumbra/mesh/mesh_topology.hpp>
#include <penumbra/mesh/solid_angle-inl.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
using Eigen::Vector3d;

namespace {

/// Inside of what bounds a body the solid angle is 4 pi, outside 0, less or more by what holes take
/// up: nearer to the one than to the other (the generalised winding number of Jacobson, Kavan and
/// Sorkine-Hornung 2013, "Robust inside-outside segmentation").
bool is_inside(double solid_angles) { return std::abs(solid_angles) > 2.0 * std::numbers::pi; }

}  // namespace

struct CameraInsideCheck::Solid {
  struct Sheet {
    std::vector<std::array<Eigen::Vector3f, 3>> triangles;
    Eigen::AlignedBox3d bounds;
    bool closed;

    [[nodiscard]] double angle(const Vector3d& eye) const {
      double sum = 0.0;
      for (const auto& [a, b, c] : triangles)
        sum += solid_angle({a.cast<double>(), b.cast<double>(), c.cast<double>()}, eye);
      return sum;
    }
  };

  std::vector<Sheet> sheets;
  Eigen::AlignedBox3d open_bounds;  // of those that are not closed
  Vector3d last_centre = Vector3d::Constant(std::nan(""));
  bool last_answer = false;

  void add(const TriangleMesh& mesh) {
    const TriangleMesh welded = weld(mesh);
    for (const MeshSheet& from : split_sheets(welded)) {
      auto& [triangles, bounds, closed] = sheets.emplace_back();
      closed = from.closed;
      triangles.reserve(from.triangles.size());
      for (const std::size_t t : from.triangles) {
        const auto& [a, b, c] = welded.triangles[t];
        triangles.push_back({welded.vertices[a], welded.vertices[b], welded.vertices[c]});
        for (const Eigen::Vector3f& p : triangles.back()) bounds.extend(p.cast<double>());
      }
      if (!closed) open_bounds.extend(bounds);
    }
  }

  /// Whether one sheet bounds the body around a point, or all open ones together do.
  [[nodiscard]] bool encloses(const Vector3d& point) const {
    const bool asks_open = open_bounds.contains(point);
    double open_angle = 0.0;
    for (const Sheet& sheet : sheets) {
      if (sheet.closed ? !sheet.bounds.contains(point) : !asks_open) continue;
      const double angle = sheet.angle(point);
      if (is_inside(angle) && sheet.bounds.contains(point)) return true;
      if (!sheet.closed) open_angle += angle;
    }
    return is_inside(open_angle);
  }

  [[nodiscard]] bool holds(const Vector3d& centre) {
    constexpr double same = 1e-7;  // metres: a camera fixed to a link moves by rounding alone
    if (!((centre - last_centre).cwiseAbs().maxCoeff() <= same)) {
      last_centre = centre;
      last_answer = encloses(centre);
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
