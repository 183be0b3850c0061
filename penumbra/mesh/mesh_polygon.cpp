// SPDX-License-Identifier: Apache-2.0
// Ear clipping: G. H. Meisters, Polygons have ears, 1975. A corner that no other one reaches into
// is cut off until a triangle is left; cost grows with the square of the corners.
#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/mesh_formats-inl.hpp>
#include <penumbra/mesh/mesh_polygon-inl.hpp>

namespace penumbra::mesh_formats {
namespace {

constexpr std::size_t most_corners = 4000;
constexpr double overlap_of_rounding = 1e-5;  // of the square of a polygon's length
constexpr double most_fold = 10.0;            // surface for each area that is seen from its front

struct Corner {
  std::uint32_t vertex;
  Eigen::Vector2d p;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a;
  const Eigen::Vector2d v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

class Polygon {
 public:
  Polygon(std::span<const std::uint32_t> corners, const TriangleMesh& mesh) {
    const auto at = [&](std::size_t i) {
      return mesh.vertices[corners[i % corners.size()]].cast<double>().eval();
    };
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // Newell's
    for (std::size_t i = 0; i < corners.size(); ++i) {
      normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
      squared_length_ = std::max(squared_length_, (at(i) - at(0)).squaredNorm());
    }
    front_ = normal.norm();
    // The axis that it faces most is left out: the others keep their coordinates without rounding.
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const Eigen::Index u = (axis + (normal[axis] < 0.0 ? 2 : 1)) % 3;
    const Eigen::Index v = 3 - axis - u;
    for (std::size_t i = 0; i < corners.size(); ++i)
      ring_.push_back({corners[i], {at(i)[u], at(i)[v]}});
  }

  void cut(TriangleMesh& mesh) {
    for (std::size_t at = 0; ring_.size() > 3; at = at == 0 ? 0 : at - 1) {
      at = find_ear(at);
      emit(at, mesh);
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    emit(1, mesh);
  }

  /// Whether the triangles that were cut cover places twice.
  [[nodiscard]] bool crosses_itself() const {
    const double rounding = overlap_of_rounding * squared_length_;
    return overlap_ > rounding || surface_ > most_fold * front_ + rounding;
  }

 private:
  [[nodiscard]] const Corner& corner(std::size_t i) const { return ring_[i % ring_.size()]; }
  [[nodiscard]] const Corner& before(std::size_t i) const { return corner(i + ring_.size() - 1); }

  [[nodiscard]] double turn(std::size_t i) const {
    return cross(before(i).p, corner(i).p, corner(i + 1).p);
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    if (turn(i) <= 0.0) return false;
    const Eigen::Vector2d& a = before(i).p;
    const Eigen::Vector2d& b = corner(i).p;
    const Eigen::Vector2d& c = corner(i + 1).p;
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const Eigen::Vector2d& p = ring_[k].p;
      if (cross(a, b, p) < 0.0 || cross(b, c, p) < 0.0 || cross(c, a, p) < 0.0) continue;
      if (p != a && p != b && p != c && turn(k) <= 0.0) return false;
    }
    return true;
  }

  /// The next ear from a corner on; the corner that turns most where rounding leaves none.
  [[nodiscard]] std::size_t find_ear(std::size_t first) const {
    std::size_t best = 0;
    for (std::size_t n = 0; n < ring_.size(); ++n) {
      const std::size_t i = (first + n) % ring_.size();
      if (is_ear(i)) return i;
      if (turn(i) > turn(best)) best = i;
    }
    return best;
  }

  void emit(std::size_t i, TriangleMesh& mesh) {
    mesh.triangles.push_back({before(i).vertex, corner(i).vertex, corner(i + 1).vertex});
    // What a triangle cut off at no ear covers too much, others wound the wrong way make up for.
    overlap_ += std::max(0.0, -turn(i));
    const auto& [a, b, c] = mesh.triangles.back();
    const Eigen::Vector3d p = mesh.vertices[a].cast<double>();
    surface_ +=
        (mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p).norm();
  }

  std::vector<Corner> ring_;
  double squared_length_ = 0.0;
  double front_ = 0.0;  // areas, doubled
  double surface_ = 0.0;
  double overlap_ = 0.0;
};

}  // namespace

void append_polygon(std::span<const std::uint32_t> corners, TriangleMesh& mesh) {
  if (corners.size() < 3) return;
  if (corners.size() == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  if (corners.size() > most_corners)
    throw FormatError("a polygon has " + std::to_string(corners.size()) + " corners, more than " +
                      std::to_string(most_corners) + "; export the mesh as triangles");
  Polygon polygon(corners, mesh);
  polygon.cut(mesh);
  // Sculpted meshes have folded quads: either diagonal covers at least what the quad does.
  if (corners.size() > 4 && polygon.crosses_itself())
    throw FormatError("a polygon crosses itself; export the mesh as triangles");
}

}  // namespace penumbra::mesh_formats
