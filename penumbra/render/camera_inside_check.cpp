// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <penumbra/mesh/surface_patches.hpp>
#include <penumbra/render/depth_renderer.hpp>

namespace penumbra {
using Eigen::Vector3d;

namespace {

/// Inside a body the solid angle of its surface is 4 pi, outside it is 0. Holes change both by less
/// than half (the generalised winding number of Jacobson, Kavan and Sorkine-Hornung 2013, "Robust
/// inside-outside segmentation").
bool is_inside(double solid_angle) { return std::abs(solid_angle) > 2.0 * std::numbers::pi; }

double angle_of(const SurfacePatch& patch, const PreparedMesh& mesh, const Vector3d& eye) {
  double sum = 0.0;
  for (const std::uint32_t triangle : patch.triangles)
    sum += solid_angle(corners_of(mesh, triangle), eye);
  return sum;
}

/// Returns whether one patch encloses a point, or all open patches together do.
bool enclose(std::span<const PreparedMesh> meshes, const Eigen::AlignedBox3d& open_bounds,
             const Vector3d& point) {
  const bool asks_open = open_bounds.contains(point);
  double open_angle = 0.0;
  for (const PreparedMesh& mesh : meshes) {
    for (const SurfacePatch& patch : mesh.patches) {
      if (patch.closed ? !patch.bounds.contains(point) : !asks_open) continue;
      const double angle = angle_of(patch, mesh, point);
      if (is_inside(angle) && patch.bounds.contains(point)) return true;
      if (!patch.closed) open_angle += angle;
    }
  }
  return is_inside(open_angle);
}

}  // namespace

CameraInsideCheck::CameraInsideCheck(std::span<const Body> bodies) {
  for (const Body& body : bodies) {
    Solid& solid = solids_.emplace_back();
    solid.meshes = body.meshes;
    for (const PreparedMesh& mesh : body.meshes)
      for (const SurfacePatch& patch : mesh.patches)
        if (!patch.closed) solid.open_bounds.extend(patch.bounds);
  }
}

std::optional<std::size_t> CameraInsideCheck::find(
    std::span<const Eigen::Isometry3d> T_camera_body) {
  constexpr double same = 1e-7;  // metres: a camera fixed to a link moves by rounding alone
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    Solid& solid = solids_[i];
    const Eigen::Isometry3d& T = T_camera_body[i];
    const Vector3d centre = -(T.linear().transpose() * T.translation());
    if (!solid.last_centre || (centre - *solid.last_centre).cwiseAbs().maxCoeff() > same) {
      solid.last_centre = centre;
      solid.last_answer = enclose(solid.meshes, solid.open_bounds, centre);
    }
    if (solid.last_answer) return i;
  }
  return std::nullopt;
}

}  // namespace penumbra
