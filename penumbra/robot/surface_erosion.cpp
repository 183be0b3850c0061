// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>
#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/surface_erosion-inl.hpp>
#include <penumbra/robot/triangle_tree-inl.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;

std::string millimetres(double metres) { return std::to_string(1e3 * metres) + " mm"; }

/// The shortest move by which a vertex comes `depth` behind all planes of its faces, as nearly as
/// one can: least squares weighted by angle, without the directions that no face tells.
Vector3d move_of(const Eigen::Matrix3d& planes, const Vector3d& normals, double depth) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(planes);
  constexpr double told = 1e-3;  // of the largest; a crease of 4 degrees
  Vector3d move = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = solver.eigenvalues()[i];
    if (value < told * solver.eigenvalues()[2]) continue;
    const Vector3d axis = solver.eigenvectors().col(i);
    move -= depth * axis * (axis.dot(normals) / value);
  }
  return move;
}

Vector3d corner(const TriangleMesh& mesh, std::size_t i, std::size_t k) {
  return mesh.vertices[mesh.triangles[i][k]].cast<double>();
}

Vector3d normal_of(const TriangleMesh& mesh, std::size_t i) {
  const Vector3d a = corner(mesh, i, 0);
  return (corner(mesh, i, 1) - a).cross(corner(mesh, i, 2) - a).stableNormalized();
}

TriangleMesh move_planes(const TriangleMesh& mesh, double depth) {
  std::vector<Eigen::Matrix3d> planes(mesh.vertices.size(), Eigen::Matrix3d::Zero());
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vector3d n = normal_of(mesh, i);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d a = corner(mesh, i, (k + 1) % 3) - corner(mesh, i, k);
      const Vector3d b = corner(mesh, i, (k + 2) % 3) - corner(mesh, i, k);
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      planes[mesh.triangles[i][k]] += angle * n * n.transpose();
      normals[mesh.triangles[i][k]] += angle * n;
    }
  }
  TriangleMesh moved = mesh;
  for (std::size_t v = 0; v < moved.vertices.size(); ++v)
    moved.vertices[v] =
        (mesh.vertices[v].cast<double>() + move_of(planes[v], normals[v], depth)).cast<float>();
  return moved;
}

[[noreturn]] void refuse(double depth, const std::string& why) {
  throw InputError("a margin of -" + millimetres(depth) + " " + why +
                   "; take a margin nearer to 0 or a simpler mesh");
}

/// Every piece still has an inside, and every face looks its way and lies `depth` from the nearest
/// of the old ones.
void verify(const TriangleMesh& mesh, const TriangleMesh& moved, double depth) {
  for (const MeshComponent& piece : connected_components(moved))
    if (piece.signed_volume <= 0.0) refuse(depth, "makes the body or a part of it vanish");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (normal_of(mesh, i).dot(normal_of(moved, i)) < 0.5)
      refuse(depth, "makes a detail of the mesh vanish");
  const TriangleTree old(mesh);
  constexpr double rounding = 1e-6;  // metres, of float corners
  const double least = depth * (1.0 - erosion_error) - rounding;
  const double most = depth * (1.0 + erosion_error) + rounding;
  const auto check = [&](const Vector3d& p) {
    if (old.comes_within(p, least) || !old.comes_within(p, most))
      refuse(depth, "does not leave a surface of that distance everywhere");
  };
  for (std::size_t i = 0; i < moved.triangles.size(); ++i) {
    Vector3d centre = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      check((corner(moved, i, k) + corner(moved, i, (k + 1) % 3)) / 2.0);
      centre += corner(moved, i, k) / 3.0;
    }
    check(centre);
  }
}

}  // namespace

TriangleMesh erode_surface(const TriangleMesh& welded, double depth) {
  TriangleMesh outward = welded;
  for (const MeshComponent& piece : connected_components(welded)) {
    if (!piece.closed)
      throw InputError("a margin of -" + millimetres(depth) +
                       " needs a closed mesh, and this one is open; take 0 or a positive margin");
    if (piece.signed_volume >= 0.0) continue;
    for (const std::size_t i : piece.triangles)
      std::swap(outward.triangles[i][1], outward.triangles[i][2]);
  }
  TriangleMesh moved = move_planes(outward, depth);
  verify(outward, moved, depth);
  return moved;
}

}  // namespace penumbra::offset
