// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <penumbra/mesh/surface_patches.hpp>
#include <penumbra/mesh/triangle_tree.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t leaf_size = 4;   // triangles
constexpr std::size_t most_levels = 64;  // halves of 2^32 triangles make 32

/// Where a ray meets a triangle.
struct Hit {
  double t = TriangleTree::nowhere;
  int side = 0;  // 1: it comes from the side on which the corners run counter-clockwise, -1: other
};

/// A ray in a frame of its own, in which it runs along the third axis: a shear, as in Woop, Benthin
/// and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013. An edge has the same product in
/// both triangles that share it, but for the sign, so no ray slips through.
class Ray {
 public:
  Ray(const Vector3d& origin, const Vector3d& direction) : origin_(origin) {
    constexpr double least = 1e-30;  // keeps products finite where a direction has zeros
    for (int i = 0; i < 3; ++i)
      inverse_[i] = 1.0 / std::copysign(std::max(std::abs(direction[i]), least), direction[i]);
    direction.cwiseAbs().maxCoeff(&z_);
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    shear_ = {direction[x_] / direction[z_], direction[y_] / direction[z_], 1.0 / direction[z_]};
  }

  [[nodiscard]] bool crosses(const Eigen::AlignedBox3f& box, double limit) const {
    constexpr double spare = 1.0 + 1e-9;  // for rounding
    const Eigen::Array3d a = (box.min().cast<double>() - origin_).array() * inverse_.array();
    const Eigen::Array3d b = (box.max().cast<double>() - origin_).array() * inverse_.array();
    const double enter = std::max(0.0, a.min(b).maxCoeff());
    return enter <= a.max(b).minCoeff() * spare && enter <= limit * spare;
  }

  [[nodiscard]] Hit meet(const std::array<Eigen::Vector3f, 3>& corners) const {
    const Vector3d a = sheared(corners[0]), b = sheared(corners[1]), c = sheared(corners[2]);
    const double u = c.x() * b.y() - c.y() * b.x();
    const double v = a.x() * c.y() - a.y() * c.x();
    const double w = b.x() * a.y() - b.y() * a.x();
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
    const double area = u + v + w;
    if (area == 0) return {};
    const double t = (u * a.z() + v * b.z() + w * c.z()) / area;
    if (!(t > 0)) return {};
    return {t, area * shear_.z() > 0 ? 1 : -1};
  }

 private:
  [[nodiscard]] Vector3d sheared(const Eigen::Vector3f& corner) const {
    const Vector3d p = corner.cast<double>() - origin_;
    return {p[x_] - shear_.x() * p[z_], p[y_] - shear_.y() * p[z_], shear_.z() * p[z_]};
  }

  Vector3d origin_, inverse_, shear_;
  Eigen::Index x_ = 0, y_ = 0, z_ = 0;
};

}  // namespace

TriangleTree::TriangleTree(const PreparedMesh& mesh) {
  std::vector<Corners> corners;
  corners.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    corners.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!order.empty()) add_node(corners, order, 0, static_cast<std::uint32_t>(order.size()));
  std::vector<std::int8_t> facing(corners.size(), 0);
  for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
    const Facing side = mesh.orientations()[i].facing;
    if (side == Facing::unknown) continue;
    for (const std::uint32_t triangle : mesh.patches[i].triangles)
      facing[triangle] = side == Facing::outwards ? 1 : -1;
  }
  for (const std::uint32_t triangle : order) {
    triangles_.push_back(corners[triangle]);
    facing_.push_back(facing[triangle]);
  }
}

/// Splits at the median along the longest side of the centroids' box.
void TriangleTree::add_node(const std::vector<Corners>& corners, std::vector<std::uint32_t>& order,
                            std::uint32_t first, std::uint32_t end) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({{}, first, end - first});
  Eigen::AlignedBox3f centroids;
  const auto centroid = [&](std::uint32_t i) -> Eigen::Vector3f {
    return (corners[i][0] + corners[i][1] + corners[i][2]) / 3.0F;
  };
  for (std::uint32_t i = first; i < end; ++i) {
    for (const Eigen::Vector3f& corner : corners[order[i]]) nodes_[node].box.extend(corner);
    centroids.extend(centroid(order[i]));
  }
  if (end - first <= leaf_size) return;
  int axis = 0;
  centroids.sizes().maxCoeff(&axis);
  const std::uint32_t half = first + (end - first) / 2;
  std::nth_element(
      order.begin() + first, order.begin() + half, order.begin() + end,
      [&](std::uint32_t a, std::uint32_t b) { return centroid(a)[axis] < centroid(b)[axis]; });
  add_node(corners, order, first, half);
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].count = 0;
  add_node(corners, order, half, end);
}

template <typename Enters, typename F>
void TriangleTree::visit(const Enters& enters, const F& f) const {
  std::array<std::uint32_t, most_levels> waiting;
  std::size_t count = 0;
  if (!nodes_.empty()) waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const Node& node = nodes_[at];
    if (!enters(node.box)) continue;
    if (node.count == 0) {
      waiting[count++] = node.first;
      waiting[count++] = at + 1;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) f(i);
  }
}

double TriangleTree::first_hit(const Vector3d& origin, const Vector3d& direction,
                               double limit) const {
  const Ray ray(origin, direction);
  double nearest = limit;
  visit([&](const Eigen::AlignedBox3f& box) { return ray.crosses(box, nearest); },
        [&](std::uint32_t i) { nearest = std::min(nearest, ray.meet(triangles_[i]).t); });
  return nearest < limit ? nearest : nowhere;
}

double TriangleTree::distance(const Vector3d& point, double limit) const {
  double nearest = limit;
  visit(
      [&](const Eigen::AlignedBox3f& box) {
        return box.cast<double>().squaredExteriorDistance(point) < nearest * nearest;
      },
      [&](std::uint32_t i) {
        const Corners& t = triangles_[i];
        nearest = std::min(
            nearest, distance_to_triangle(
                         point, {t[0].cast<double>(), t[1].cast<double>(), t[2].cast<double>()}));
      });
  return nearest < limit ? nearest : nowhere;
}

bool TriangleTree::encloses(const Vector3d& point) const {
  if (nodes_.empty() || !nodes_[0].box.cast<double>().contains(point)) return false;
  const Vector3d direction(0.3571, 0.5673, 0.7421);                        // along no axis
  return winding(point, direction) > 0 || winding(point, -direction) > 0;  // one may pass a hole
}

int TriangleTree::winding(const Vector3d& point, const Vector3d& direction) const {
  const Ray ray(point, direction);
  int winding = 0;
  visit([&](const Eigen::AlignedBox3f& box) { return ray.crosses(box, nowhere); },
        [&](std::uint32_t i) { winding -= facing_[i] * ray.meet(triangles_[i]).side; });
  return winding;
}

}  // namespace penumbra
