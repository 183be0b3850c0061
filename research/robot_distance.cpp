// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <research/robot_distance.hpp>

namespace penumbra::research {
namespace {

/// Returns the squared distance of the origin from a segment.
double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0.0;
  return (a + t * d).squaredNorm();
}

/// Returns the squared distance of the origin from a triangle.
double squared_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
  const double edges =
      std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area == 0) return edges;
  const bool inside =
      normal.dot(a.cross(b)) >= 0 && normal.dot(b.cross(c)) >= 0 && normal.dot(c.cross(a)) >= 0;
  return inside ? std::min(edges, normal.dot(a) * normal.dot(a) / area) : edges;
}

/// Returns the squared distance of a point from a mesh; infinite if the mesh has no triangle.
double squared_distance(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  const auto corner = [&](std::uint32_t i) {
    return Eigen::Vector3d(mesh.vertices[i].template cast<double>() - point);
  };
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    least = std::min(least, squared_distance(corner(t[0]), corner(t[1]), corner(t[2])));
  return least;
}

}  // namespace

std::optional<double> distance_to_robot(const Robot& robot, std::span<const double> joints,
                                        const Eigen::Vector3d& point, double most) {
  std::vector<Eigen::Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(joints, poses);
  double least = std::numeric_limits<double>::infinity();  // squared
  for (std::size_t link = 0; link < poses.size(); ++link) {
    const Eigen::Vector3d in_link = poses[link].inverse() * point;
    if (!robot.report()[link].drawn ||
        robot.report()[link].bounds.squaredExteriorDistance(in_link) > most * most)
      continue;
    for (const TriangleMesh& mesh : robot.meshes(link))
      least = std::min(least, squared_distance(mesh, in_link));
  }
  if (least > most * most) return std::nullopt;
  return std::sqrt(least);
}

}  // namespace penumbra::research
