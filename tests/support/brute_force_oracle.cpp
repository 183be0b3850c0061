// SPDX-License-Identifier: Apache-2.0
#include "brute_force_oracle.hpp"

namespace penumbra::test {
namespace {

using Vector3 = Eigen::Matrix<long double, 3, 1>;

struct Meeting {
  Vector3 normal;
  long double offset;  // normal . x on the triangle's plane
  long double z;
};

/// Moller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection"; edges included.
std::optional<Meeting> meet(const std::array<Eigen::Vector3d, 3>& corners, const Vector3& ray) {
  const Vector3 a = corners[0].cast<long double>();
  const Vector3 ab = corners[1].cast<long double>() - a;
  const Vector3 ac = corners[2].cast<long double>() - a;
  const Vector3 p = ray.cross(ac);
  const long double determinant = ab.dot(p);
  if (determinant == 0) return std::nullopt;
  const long double s = -a.dot(p) / determinant;
  const Vector3 q = (-a).cross(ab);
  const long double t = ray.dot(q) / determinant;
  if (s < 0 || t < 0 || s + t > 1) return std::nullopt;
  const Vector3 normal = ab.cross(ac);
  return Meeting{normal, normal.dot(a), ac.dot(q) / determinant};
}

}  // namespace

BruteForceOracle::BruteForceOracle(std::span<const Body> bodies,
                                   std::span<const Eigen::Isometry3d> T_camera_body) {
  for (std::size_t body = 0; body < bodies.size(); ++body)
    for (const TriangleMesh& mesh : bodies[body].meshes)
      for (const auto& triangle : mesh.triangles) {
        Triangle& placed = triangles_.emplace_back();
        placed.body = body;
        for (std::size_t i = 0; i < 3; ++i)
          placed.corners[i] = T_camera_body[body] * mesh.vertices[triangle[i]].cast<double>();
        for (std::size_t i = 0; i < 3; ++i) {
          const Eigen::Vector3d& a = placed.corners[i];
          const Eigen::Vector3d& b = placed.corners[(i + 1) % 3];
          placed.sides[i] = a.cross(b);
          placed.doubt[i] = 1e-14 * a.norm() * b.norm();
        }
        placed.middle.setZero();
        for (const auto& corner : placed.corners) placed.middle += corner.normalized();
        placed.middle.normalize();
        placed.least = 1.0;
        for (const auto& corner : placed.corners)
          placed.least = std::min(placed.least, placed.middle.dot(corner.normalized()) - 1e-12);
        if (!(placed.least > 0.1)) placed.least = -2.0;
      }
}

template <typename F>
void BruteForceOracle::for_each_hit(const Eigen::Vector3d& direction, F&& f) const {
  const Vector3 ray = direction.cast<long double>();
  const double length = direction.norm();
  for (const Triangle& triangle : triangles_) {
    if (triangle.middle.dot(direction) < triangle.least * length) continue;
    bool left = false, right = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = triangle.sides[i].dot(direction);
      left = left || side > triangle.doubt[i] * length;
      right = right || side < -triangle.doubt[i] * length;
    }
    if (left && right) continue;
    const auto meeting = meet(triangle.corners, ray);
    if (!meeting) continue;
    f(RayHit{double(meeting->z), triangle.body,
             (meeting->normal / meeting->offset).cast<double>()});
  }
}

std::optional<RayHit> BruteForceOracle::first_hit(const Eigen::Vector3d& direction,
                                                  double from_z) const {
  std::optional<RayHit> nearest;
  for_each_hit(direction, [&](const RayHit& hit) {
    if (hit.z >= from_z && (!nearest || hit.z < nearest->z)) nearest = hit;
  });
  return nearest;
}

std::vector<RayHit> BruteForceOracle::all_hits(const Eigen::Vector3d& direction, double from_z,
                                               double to_z) const {
  std::vector<RayHit> hits;
  for_each_hit(direction, [&](const RayHit& hit) {
    if (hit.z >= from_z && hit.z <= to_z) hits.push_back(hit);
  });
  return hits;
}

}  // namespace penumbra::test
