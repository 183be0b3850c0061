// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>
#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/depth_refinement-inl.hpp>
#include <penumbra/robot/depth_surface-inl.hpp>
#include <penumbra/robot/offset_cleanup-inl.hpp>
#include <penumbra/robot/surface_erosion-inl.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;

constexpr double widest_cell = 0.9;        // of the depth
constexpr double sure_cell = 0.3;          // of the depth: nothing of substance slips through
constexpr double fewest_triangles = 60e3;  // of a grid's result, on the average
constexpr double most_triangles = 1e6;
constexpr std::size_t most_cells = 16'000'000;

std::string millimetres(double metres) {
  std::ostringstream text;
  text << 1e3 * metres << " mm";
  return text.str();
}

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
  throw InputError("a margin of -" + millimetres(depth) + " " + why);
}

DepthBounds bounds(double depth, double outwards, double inwards) {
  constexpr double rounding = 1e-6;  // metres, of float corners
  return {depth, depth * (1.0 - outwards) - rounding, depth * (1.0 + inwards) + rounding};
}

double area_of(const TriangleMesh& mesh, std::size_t i) {
  const Vector3d a = corner(mesh, i, 0);
  return (corner(mesh, i, 1) - a).cross(corner(mesh, i, 2) - a).norm() / 2.0;
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) sum += area_of(mesh, i);
  return sum;
}

/// Whether a piece is thicker than the rounding of its corners, half its area taken for its width.
bool has_inside(const TriangleMesh& mesh, const MeshComponent& piece) {
  constexpr double thinnest = 1e-5;  // metres
  double area = 0.0;
  for (const std::size_t i : piece.triangles) area += area_of(mesh, i);
  return piece.signed_volume > thinnest * area / 2.0;
}

/// Every piece still has an inside, and every face looks its way and lies at the depth.
bool keeps_details(const TriangleMesh& mesh, const TriangleMesh& moved, const TriangleTree& old,
                   double depth) {
  for (const MeshComponent& piece : connected_components(moved))
    if (!has_inside(moved, piece)) return false;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (normal_of(mesh, i).dot(normal_of(moved, i)) < 0.5) return false;
  return keeps_depth(moved, old, bounds(depth, plane_error, plane_error));
}

TriangleMesh erode_on_grid(const TriangleMesh& solid, const TriangleTree& tree, double depth) {
  const double area = area_of(solid);
  const auto cell_for = [area](double triangles) { return std::sqrt(3.0 * area / triangles); };
  const DepthBounds wanted = bounds(depth, shrink_error_outwards, shrink_error_inwards);
  constexpr double refinement = 0.7;
  bool vanishes = false;
  for (double cell = std::min(widest_cell * depth, cell_for(fewest_triangles));
       cell >= cell_for(most_triangles); cell *= refinement) {
    const DepthGrid grid(solid, tree, depth, cell, most_cells);
    if (!grid.fits()) break;
    if (grid.misses(wanted.most)) continue;
    TriangleMesh eroded = extract_surface(grid, tree, depth);
    vanishes = eroded.triangles.empty();
    if (vanishes && cell < sure_cell * depth) break;
    if (vanishes) continue;
    if (!refine_to_depth(eroded, tree, wanted)) continue;
    separate_vertices(eroded);
    return eroded;
  }
  if (vanishes) refuse(depth, "leaves nothing of the mesh; take a margin nearer to 0");
  const double easier =
      std::max(1.5 * depth, cell_for(most_triangles) / (refinement * widest_cell));
  refuse(depth, "would need millions of triangles; take 0 or try -" + millimetres(easier) +
                    " or a mesh with fewer fine details");
}

}  // namespace

TriangleMesh erode_surface(const TriangleMesh& welded, double depth) {
  TriangleMesh outward = welded;
  for (const MeshComponent& piece : connected_components(welded)) {
    if (!piece.closed)
      refuse(depth, "needs a closed mesh, and this one is open; take 0 or a positive margin");
    if (piece.signed_volume >= 0.0) continue;
    for (const std::size_t i : piece.triangles)
      std::swap(outward.triangles[i][1], outward.triangles[i][2]);
  }
  const TriangleTree tree(outward);
  TriangleMesh moved = move_planes(outward, depth);
  if (keeps_details(outward, moved, tree, depth)) return moved;
  return erode_on_grid(outward, tree, depth);
}

}  // namespace penumbra::offset
