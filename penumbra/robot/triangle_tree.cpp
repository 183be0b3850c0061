// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <penumbra/robot/triangle_tree-inl.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;

// Twice the depth of a tree of 2^32 triangles: the median halves them at each level.
constexpr std::size_t most_open = 64;

Vector3d nearest_of_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  return a + std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) * ab;
}

Vector3d nearest_of_triangle(const Vector3d& p, const std::array<Eigen::Vector3f, 3>& t) {
  const Vector3d a = t[0].cast<double>();
  const Vector3d b = t[1].cast<double>();
  const Vector3d c = t[2].cast<double>();
  const Vector3d n = (b - a).cross(c - a);
  const bool over_face = n.dot((b - a).cross(p - a)) >= 0.0 && n.dot((c - b).cross(p - b)) >= 0.0 &&
                         n.dot((a - c).cross(p - c)) >= 0.0;
  if (over_face) return p - n * (n.dot(p - a) / n.squaredNorm());
  Vector3d nearest = nearest_of_segment(p, a, b);
  for (const Vector3d& q : {nearest_of_segment(p, b, c), nearest_of_segment(p, c, a)})
    if ((q - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = q;
  return nearest;
}

double squared_distance(const Eigen::AlignedBox3f& box, const Vector3d& p) {
  const Vector3d low = box.min().cast<double>() - p;
  const Vector3d high = p - box.max().cast<double>();
  return low.cwiseMax(high).cwiseMax(0.0).squaredNorm();
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    triangles_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  nodes_.emplace_back();
  build(triangles_.begin(), triangles_.end(), 0);
}

void TriangleTree::build(std::vector<Corners>::iterator begin, std::vector<Corners>::iterator end,
                         std::uint32_t node) {
  constexpr std::ptrdiff_t leaf_size = 4;
  Eigen::AlignedBox3f box;
  for (auto it = begin; it != end; ++it)
    for (const Eigen::Vector3f& corner : *it) box.extend(corner);
  nodes_[node] = {box, static_cast<std::uint32_t>(begin - triangles_.begin()),
                  static_cast<std::uint32_t>(end - begin)};
  if (end - begin <= leaf_size) return;

  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto middle = begin + (end - begin) / 2;
  const auto centre = [axis](const Corners& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::nth_element(begin, middle, end,
                   [&centre](const Corners& a, const Corners& b) { return centre(a) < centre(b); });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = child;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(begin, middle, child);
  build(middle, end, child + 1);
}

bool TriangleTree::comes_within(const Vector3d& p, double reach) const {
  std::array<std::uint32_t, most_open> open{0};
  for (std::size_t n = 1; n > 0;) {
    const Node& node = nodes_[open[--n]];
    if (squared_distance(node.box, p) >= reach * reach) continue;
    if (node.count == 0) {
      open[n++] = node.first;
      open[n++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if ((nearest_of_triangle(p, triangles_[i]) - p).squaredNorm() < reach * reach) return true;
  }
  return false;
}

Vector3d TriangleTree::nearest(const Vector3d& p, double reach) const {
  struct Open {
    std::uint32_t node;
    double squared;
  };
  std::array<Open, most_open> open{Open{0, squared_distance(nodes_[0].box, p)}};
  Vector3d found = p;
  double least = reach * reach;
  for (std::size_t n = 1; n > 0;) {
    const auto [index, squared] = open[--n];
    if (squared >= least) continue;
    const Node& node = nodes_[index];
    if (node.count == 0) {
      Open near{node.first, squared_distance(nodes_[node.first].box, p)};
      Open far{node.first + 1, squared_distance(nodes_[node.first + 1].box, p)};
      if (far.squared < near.squared) std::swap(near, far);
      open[n++] = far;
      open[n++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vector3d q = nearest_of_triangle(p, triangles_[i]);
      if ((q - p).squaredNorm() >= least) continue;
      least = (q - p).squaredNorm();
      found = q;
    }
  }
  return found;
}

}  // namespace penumbra::offset
