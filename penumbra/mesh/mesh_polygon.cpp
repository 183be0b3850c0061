// SPDX-License-Identifier: Apache-2.0
// Ear clipping (G. H. Meisters 1975, "Polygons have ears"): cuts off a corner whose triangle
// contains no other corner until one triangle is left. The cost grows with the square of the
// corners.
#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/mesh_formats.hpp>

namespace penumbra::mesh_formats {
namespace {

constexpr std::size_t most_corners = 4000;

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
    for (std::size_t i = 0; i < corners.size(); ++i)
      normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
    // Project along the main axis of the normal: the other coordinates keep all digits.
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

  /// Returns the next ear from a corner on, or the corner that turns most if there is no ear, as in
  /// a polygon that crosses itself.
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
  }

  std::vector<Corner> ring_;
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
  Polygon(corners, mesh).cut(mesh);
}

}  // namespace penumbra::mesh_formats
