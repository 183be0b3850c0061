// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <penumbra/render/near_plane_check.hpp>

namespace penumbra {
using Eigen::Vector3d;

namespace {

constexpr double same_pose = 1e-7;  // metres and per element: a rigid mount moves by rounding alone
constexpr double near_rounding = 1e-6;  // of the near plane: what lies on it is drawn

/// A point is inside where normal.dot(point) <= offset.
struct Plane {
  Vector3d normal;
  double offset;

  [[nodiscard]] double beyond(const Vector3d& point) const { return normal.dot(point) - offset; }
};

constexpr std::size_t plane_count = 5;

/// A triangle that planes cut: each doubles its corners at most, however it rounds.
struct CutTriangle {
  std::array<Vector3d, 3U << plane_count> corners;
  std::size_t count = 0;

  void add(const Vector3d& corner) { corners[count++] = corner; }
};

CutTriangle cut(const CutTriangle& left, const Plane& plane) {
  CutTriangle rest;
  for (std::size_t i = 0; i < left.count; ++i) {
    const Vector3d& a = left.corners[i];
    const Vector3d& b = left.corners[(i + 1) % left.count];
    const double at_a = plane.beyond(a);
    const double at_b = plane.beyond(b);
    if (at_a <= 0.0) rest.add(a);
    if ((at_a <= 0.0) != (at_b <= 0.0)) rest.add(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return rest;
}

/// The pyramid between the camera's centre and the near plane, in a body's frame.
struct NearPyramid {
  std::array<Plane, plane_count> planes;
  Eigen::AlignedBox3d bounds;

  [[nodiscard]] bool holds_part_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) const {
    if (!bounds.intersects(
            Eigen::AlignedBox3d(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c))))
      return false;
    CutTriangle left;
    for (const Vector3d& corner : {a, b, c}) left.add(corner);
    for (const Plane& plane : planes) {
      left = cut(left, plane);
      if (left.count == 0) return false;
    }
    return true;
  }

  [[nodiscard]] bool holds_part_of(const TriangleMesh& mesh) const {
    const auto at = [&](std::uint32_t i) { return mesh.vertices[i].cast<double>().eval(); };
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                       [&](const auto& t) { return holds_part_of(at(t[0]), at(t[1]), at(t[2])); });
  }
};

/// `corners`: of the image on the near plane.
NearPyramid region_of(const std::array<Vector3d, 4>& corners,
                      const Eigen::Isometry3d& T_camera_body) {
  const Eigen::Matrix3d R_body_camera = T_camera_body.linear().transpose();
  const Vector3d eye = -(R_body_camera * T_camera_body.translation());
  NearPyramid region;
  region.bounds.extend(eye);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d normal = R_body_camera * corners[(i + 1) % 4].cross(corners[i]).normalized();
    region.planes[i] = {normal, normal.dot(eye)};
    region.bounds.extend(eye + R_body_camera * corners[i]);
  }
  const Vector3d forward = R_body_camera.col(2);
  region.planes[4] = {forward, forward.dot(eye) + corners[0].z()};
  return region;
}

}  // namespace

NearPlaneCheck::NearPlaneCheck(const Intrinsics& intrinsics, std::span<const Body> bodies) {
  const double z = DepthRenderer::near_plane * (1.0 - near_rounding);
  const auto on_plane = [&](double u, double v) {
    return Vector3d((u - intrinsics.cx()) / intrinsics.fx() * z,
                    (v - intrinsics.cy()) / intrinsics.fy() * z, z);
  };
  const double right = intrinsics.width() - 0.5;
  const double low = intrinsics.height() - 0.5;
  corners_ = {on_plane(-0.5, -0.5), on_plane(right, -0.5), on_plane(right, low),
              on_plane(-0.5, low)};
  reach_ = 0.0;
  for (const Vector3d& corner : corners_) reach_ = std::max(reach_, corner.norm());
  for (const Body& body : bodies) {
    Part& part = parts_.emplace_back();
    part.meshes = body.meshes;
    for (const TriangleMesh& mesh : body.meshes)
      for (const Eigen::Vector3f& vertex : mesh.vertices)
        part.bounds.extend(vertex.cast<double>().eval());
  }
  found_.reserve(parts_.size());
}

bool NearPlaneCheck::reaches(Part& part, const Eigen::Isometry3d& T_camera_body) const {
  if (part.bounds.isEmpty()) return false;
  const Vector3d eye = -(T_camera_body.linear().transpose() * T_camera_body.translation());
  if (part.bounds.squaredExteriorDistance(eye) > reach_ * reach_) return false;
  if (part.was_asked &&
      (T_camera_body.matrix() - part.last_pose.matrix()).cwiseAbs().maxCoeff() <= same_pose)
    return part.last_answer;
  const NearPyramid region = region_of(corners_, T_camera_body);
  part.was_asked = true;
  part.last_pose = T_camera_body;
  part.last_answer =
      region.bounds.intersects(part.bounds) &&
      std::any_of(part.meshes.begin(), part.meshes.end(),
                  [&](const TriangleMesh& mesh) { return region.holds_part_of(mesh); });
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
