// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>
#include <penumbra/base/text.hpp>
#include <penumbra/mesh/mesh_formats.hpp>
#include <penumbra/mesh/simplified.hpp>
#include <penumbra/mesh/surface_offset.hpp>
#include <penumbra/mesh/surface_patches.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double finest_cell = 0.003;    // metres
constexpr double coarsest_cell = 0.006;  // for margins up to twice as large
constexpr double most_cells = 300e3;     // on a surface: a second or two
constexpr double simplification = 3e-4;  // metres

struct Nearest {
  double distance;
  double angle;  // of the face at its nearest point: pi within the face and along an edge
};

/// A triangle, prepared for distances.
class Face {
 public:
  explicit Face(const std::array<Vector3d, 3>& corners) : corners_(corners) {
    const auto& [a, b, c] = corners_;
    normal_ = (b - a).cross(c - a).stableNormalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d next = corners_[(k + 1) % 3] - corners_[k];
      const Vector3d previous = corners_[(k + 2) % 3] - corners_[k];
      outward_[k] = next.cross(normal_);
      angles_[k] = std::atan2(next.cross(previous).norm(), next.dot(previous));
    }
    centre_ = (a + b + c) / 3.0;
    radius_ = std::max({(a - centre_).norm(), (b - centre_).norm(), (c - centre_).norm()});
  }

  [[nodiscard]] Nearest nearest(const Vector3d& p) const {
    Nearest best{infinite, std::numbers::pi};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d to_p = p - corners_[k];
      if (outward_[k].dot(to_p) <= 0.0) continue;
      const Vector3d edge = corners_[(k + 1) % 3] - corners_[k];
      const double fraction = std::clamp(to_p.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      const double distance = (to_p - fraction * edge).norm();
      if (distance >= best.distance) continue;
      const bool at_corner = fraction == 0.0 || fraction == 1.0;
      best = {distance,
              at_corner ? angles_[(k + (fraction == 1.0 ? 1 : 0)) % 3] : std::numbers::pi};
    }
    return best.distance == infinite ? Nearest{std::abs(height(p)), std::numbers::pi} : best;
  }

  /// Returns the distance to the face's plane, negative behind it.
  [[nodiscard]] double height(const Vector3d& p) const { return normal_.dot(p - corners_[0]); }

  /// Whether a ball around the face is farther than `distance`.
  [[nodiscard]] bool is_beyond(const Vector3d& p, double distance) const {
    const double reach = distance + radius_;
    return (p - centre_).squaredNorm() > reach * reach;
  }

 private:
  std::array<Vector3d, 3> corners_;
  std::array<Vector3d, 3> outward_;  // per edge: away from the face, in its plane
  std::array<double, 3> angles_;     // at the corners
  Vector3d normal_;
  Vector3d centre_;
  double radius_;
};

struct Grid {
  Vector3d origin;
  double cell;   // metres
  double level;  // distance of the surface to find, metres
};

/// Finds the surface at a distance from faces with marching tetrahedra on an octree. Distances are
/// negative behind the faces of a solid; other faces have two outer sides.
class LevelSurface {
 public:
  LevelSurface(const std::vector<Face>& faces, bool solid, const Grid& grid)
      : faces_(faces), solid_(solid), grid_(grid) {}

  /// Returns the surface in the grid's first extent^3 metres.
  TriangleMesh find(double extent) {
    int size = 2;
    while (size * grid_.cell < extent) size *= 2;
    Faces all(faces_.size());
    std::iota(all.begin(), all.end(), 0U);
    visit(Vector3i::Zero(), size, all);
    return weld(surface_);
  }

 private:
  using Faces = std::vector<std::uint32_t>;
  struct Node {
    Vector3d point;
    double value;  // distance beyond the level
  };

  [[nodiscard]] Vector3d point_at(const Vector3i& node) const {
    return grid_.origin + grid_.cell * node.cast<double>();
  }

  static Vector3i octant(int k) { return {k & 1, k >> 1 & 1, k >> 2 & 1}; }

  /// Visits a block of size^3 cells. `near` contains the faces nearest to any point of it.
  void visit(const Vector3i& corner, int size, const Faces& near) {
    const Vector3d middle = point_at(corner) + Vector3d::Constant(0.5 * size * grid_.cell);
    const double radius = 0.5 * std::sqrt(3.0) * size * grid_.cell;
    double least = infinite;
    std::vector<std::pair<double, std::uint32_t>> found;  // the nearest first
    for (const std::uint32_t i : near) {
      if (faces_[i].is_beyond(middle, least + 2.0 * radius)) continue;
      found.emplace_back(faces_[i].nearest(middle).distance, i);
      if (found.back().first < least) std::swap(found.front(), found.back());
      least = found.front().first;
    }
    if (std::abs(least - std::abs(grid_.level)) > radius) return;
    Faces nearer;
    for (const auto& [distance, i] : found)
      if (distance <= least + 2.0 * radius) nearer.push_back(i);
    for (int k = 0; k < 8; ++k) {
      const Vector3i part = corner + size / 2 * octant(k);
      if (size > 2)
        visit(part, size / 2, nearer);
      else
        add_cell(part, nearer);
    }
  }

  void add_cell(const Vector3i& corner, const Faces& near) {
    std::array<Node, 8> nodes;
    std::size_t inside = 0;
    for (int k = 0; k < 8; ++k) {
      Node& node = nodes[static_cast<std::size_t>(k)];
      node = node_at(corner + octant(k), near);
      if (node.value < 0.0) ++inside;
    }
    if (inside == 0 || inside == nodes.size()) return;
    // Six tetrahedra around a diagonal (Kuhn): neighbouring cells split their common side equally.
    std::array<std::size_t, 3> axes{1, 2, 4};
    do {
      add_tetrahedron({nodes[0], nodes[axes[0]], nodes[axes[0] + axes[1]], nodes[7]});
    } while (std::next_permutation(axes.begin(), axes.end()));
  }

  void add_tetrahedron(const std::array<Node, 4>& nodes) {
    std::vector<Node> inside;
    std::vector<Node> outside;
    for (const Node& node : nodes) (node.value < 0.0 ? inside : outside).push_back(node);
    if (inside.empty() || outside.empty()) return;
    std::vector<Vector3d> polygon;
    for (const Node& from : inside) {
      for (const Node& to : outside) {
        const double fraction = from.value / (from.value - to.value);
        polygon.push_back(from.point + fraction * (to.point - from.point));
      }
      std::reverse(outside.begin(), outside.end());  // the order around a quadrangle
    }
    add_polygon(polygon, outside[0].point - inside[0].point);
  }

  void add_polygon(const std::vector<Vector3d>& polygon, const Vector3d& outward) {
    const Vector3d normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    const bool turned = normal.dot(outward) < 0.0;
    const auto first = static_cast<std::uint32_t>(surface_.vertices.size());
    for (const Vector3d& p : polygon) surface_.vertices.push_back(p.cast<float>());
    for (std::uint32_t i = first + 2; i < surface_.vertices.size(); ++i)
      surface_.triangles.push_back({first, turned ? i : i - 1, turned ? i - 1 : i});
  }

  Node node_at(const Vector3i& node, const Faces& near) {
    const Eigen::Matrix<std::uint64_t, 3, 1> n = node.cast<std::uint64_t>();
    const auto [at, is_new] = values_.try_emplace(n.x() | n.y() << 21 | n.z() << 42);
    const Vector3d point = point_at(node);
    if (is_new) {
      const double value = signed_distance(point, near) - grid_.level;
      const double least = 1e-3 * grid_.cell;  // keeps the vertices of the surface apart
      at->second = std::copysign(std::max(std::abs(value), least), value);
    }
    return {point, at->second};
  }

  /// Returns the distance, signed by the heights over the nearest faces, weighted at a common edge
  /// or corner by their angles (Baerentzen and Aanaes 2005, "Signed distance computation using the
  /// angle weighted pseudonormal").
  [[nodiscard]] double signed_distance(const Vector3d& p, const Faces& near) const {
    constexpr double same = 1e-9;  // metres
    double least = infinite;
    double height = 0.0;
    for (const std::uint32_t i : near) {
      if (faces_[i].is_beyond(p, least + same)) continue;
      const auto [distance, angle] = faces_[i].nearest(p);
      if (distance > least + same) continue;
      if (distance < least - same) height = 0.0;
      height += angle * faces_[i].height(p);
      least = std::min(least, distance);
    }
    return solid_ && height < 0.0 ? -least : least;
  }

  const std::vector<Face>& faces_;
  bool solid_;
  Grid grid_;
  std::unordered_map<std::uint64_t, double> values_;  // of nodes
  TriangleMesh surface_;
};

[[noreturn]] void refuse(double margin, const std::string& why) {
  throw InputError("a margin of " + detail::printed(1e3 * margin) + " mm " + why);
}

/// Returns a grid around a surface within `bounds`, which include the margin.
Grid grid_for(double margin, const Eigen::AlignedBox3d& bounds) {
  const Vector3d size = bounds.sizes();
  const double area = 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  const double least = std::sqrt(area / most_cells);
  if (least > std::max(margin / 2.0, margin < 0.0 ? finest_cell : coarsest_cell))
    refuse(margin, "is too fine for a mesh of " + detail::printed(size.maxCoeff()) +
                       " m; use 0, split the mesh or use boxes and cylinders");
  const double cell = std::max(least, std::clamp(margin / 2.0, finest_cell, coarsest_cell));
  double level = margin;
  if (margin > 0.0) {
    // Add the sagitta of chords at rounded edges, and keep nodes inside wires and corners.
    const double sagitta = std::min(3.0 * cell * cell / (8.0 * margin), cell / 4.0);
    level = std::max(margin + sagitta, 0.75 * cell);
  }
  return {bounds.min() - Vector3d::Constant(2.0 * cell), cell, level};
}

TriangleMesh offset_patch(const PreparedMesh& mesh, std::size_t number, double margin) {
  const SurfacePatch& patch = mesh.patches[number];
  const auto& [facing, holes] = mesh.orientations()[number];
  // The margin closes smaller holes.
  const bool solid = facing != Facing::unknown &&
                     std::all_of(holes.begin(), holes.end(),
                                 [&](const Ball& hole) { return hole.radius < std::abs(margin); });
  if (margin < 0.0 && !solid)
    refuse(margin, "needs a closed mesh, and this one is open; use 0 or a positive margin");
  std::vector<Face> faces;
  for (const std::uint32_t i : patch.triangles) {
    std::array<Vector3d, 3> corners = corners_of(mesh, i);
    if (facing == Facing::inwards) std::swap(corners[1], corners[2]);
    faces.emplace_back(corners);
  }
  const Vector3d growth = Vector3d::Constant(std::max(margin, 0.0));
  const Eigen::AlignedBox3d bounds(patch.bounds.min() - growth, patch.bounds.max() + growth);
  const Grid grid = grid_for(margin, bounds);
  return simplified(
      LevelSurface(faces, solid, grid).find(bounds.sizes().maxCoeff() + 4.0 * grid.cell),
      simplification);
}

}  // namespace

PreparedMesh offset_surface(const PreparedMesh& mesh, double margin) {
  if (!std::isfinite(margin))
    throw InputError("a margin is " + std::to_string(margin) + "; it must be finite (metres)");
  if (margin == 0.0) return mesh;
  TriangleMesh result;
  for (std::size_t i = 0; i < mesh.patches.size(); ++i)
    mesh_formats::append_placed(offset_patch(mesh, i, margin), Eigen::Affine3d::Identity(), result);
  return PreparedMesh(result);
}

}  // namespace penumbra
