// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <penumbra/render/near_plane_check.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double same_pose = 1e-7;  // metres and per element: a rigid mount moves by rounding alone
constexpr double near_rounding = 1e-6;  // of the near plane: what lies on it is drawn

/// A triangle that planes cut. Each plane doubles its corners at most, whatever the rounding.
template <std::size_t Planes>
struct CutTriangle {
  std::array<Vector3d, 3U << Planes> corners;
  std::size_t count = 0;

  void add(const Vector3d& corner) { corners[count++] = corner; }
};

/// Returns whether a part of a triangle lies on the positive side of all planes (Sutherland and
/// Hodgman 1974, "Reentrant polygon clipping").
template <std::size_t Planes>
bool has_part_inside(const std::array<Vector4d, Planes>& planes, const Vector3d& a,
                     const Vector3d& b, const Vector3d& c) {
  CutTriangle<Planes> left;
  for (const Vector3d& corner : {a, b, c}) left.add(corner);
  for (const Vector4d& plane : planes) {
    CutTriangle<Planes> rest;
    for (std::size_t i = 0; i < left.count; ++i) {
      const Vector3d& p = left.corners[i];
      const Vector3d& q = left.corners[(i + 1) % left.count];
      const double at_p = plane.dot(p.homogeneous());
      const double at_q = plane.dot(q.homogeneous());
      if (at_p >= 0.0) rest.add(p);
      if ((at_p >= 0.0) != (at_q >= 0.0)) rest.add(p + (q - p) * (at_p / (at_p - at_q)));
    }
    left = rest;
    if (left.count == 0) return false;
  }
  return true;
}

}  // namespace

NearPlaneCheck::NearPlaneCheck(const Intrinsics& k, std::span<const Body> bodies) {
  const double near = DepthRenderer::near_plane * (1.0 - near_rounding);
  const double right = k.width() - 0.5;
  const double low = k.height() - 0.5;
  planes_ = {Vector4d(k.fx(), 0, k.cx() + 0.5, 0), Vector4d(-k.fx(), 0, right - k.cx(), 0),
             Vector4d(0, k.fy(), k.cy() + 0.5, 0), Vector4d(0, -k.fy(), low - k.cy(), 0),
             Vector4d(0, 0, -1, near)};
  for (const double u : {-0.5, right})
    for (const double v : {-0.5, low}) reach_ = std::max(reach_, near * k.ray(u, v).norm());
  for (const Body& body : bodies) {
    Part& part = parts_.emplace_back();
    part.meshes = body.meshes;
    for (const PreparedMesh& mesh : body.meshes) part.bounds.extend(mesh.bounds);
  }
  found_.reserve(parts_.size());
}

bool NearPlaneCheck::reaches(const PreparedMesh& mesh,
                             const Eigen::Isometry3d& T_camera_body) const {
  const auto at = [&](std::uint32_t i) -> Vector3d {
    return T_camera_body * mesh.vertices[i].cast<double>();
  };
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    return has_part_inside(planes_, at(t[0]), at(t[1]), at(t[2]));
  });
}

bool NearPlaneCheck::reaches(Part& part, const Eigen::Isometry3d& T_camera_body) const {
  if (part.bounds.isEmpty()) return false;
  const Vector3d eye = -(T_camera_body.linear().transpose() * T_camera_body.translation());
  if (part.bounds.exteriorDistance(eye) > reach_) return false;
  if (!part.last_pose ||
      (T_camera_body.matrix() - part.last_pose->matrix()).cwiseAbs().maxCoeff() > same_pose) {
    part.last_pose = T_camera_body;
    part.last_answer =
        std::any_of(part.meshes.begin(), part.meshes.end(),
                    [&](const PreparedMesh& mesh) { return reaches(mesh, T_camera_body); });
  }
  return part.last_answer;
}

std::span<const std::size_t> NearPlaneCheck::find(
    std::span<const Eigen::Isometry3d> T_camera_body) {
  found_.clear();
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (reaches(parts_[i], T_camera_body[i])) found_.push_back(i);
  return found_;
}

}  // namespace penumbra
