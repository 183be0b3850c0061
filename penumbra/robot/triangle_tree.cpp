// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include <penumbra/robot/triangle_tree-inl.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;

double squared_distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).squaredNorm();
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  for (const auto& t : mesh.triangles)
    centres_.push_back(
        (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).cast<double>() / 3.0);
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(order_.size()));
}

void TriangleTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t leaf_size = 4;
  Eigen::AlignedBox3d box;
  for (std::uint32_t i = first; i < first + count; ++i)
    for (const std::uint32_t corner : mesh_.triangles[order_[i]])
      box.extend(mesh_.vertices[corner].cast<double>());
  nodes_[node] = {box, first, count};
  if (count <= leaf_size) return;

  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [this, axis](std::uint32_t a, std::uint32_t b) {
                     return centres_[a][axis] < centres_[b][axis];
                   });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = child;
  nodes_[node].count = 0;
  nodes_.resize(nodes_.size() + 2);
  build(child, first, count / 2);
  build(child + 1, first + count / 2, count - count / 2);
}

double TriangleTree::squared_distance(const Vector3d& p, std::uint32_t triangle) const {
  const auto& t = mesh_.triangles[triangle];
  const Vector3d a = mesh_.vertices[t[0]].cast<double>();
  const Vector3d b = mesh_.vertices[t[1]].cast<double>();
  const Vector3d c = mesh_.vertices[t[2]].cast<double>();
  const Vector3d n = (b - a).cross(c - a);
  const bool over_face = n.dot((b - a).cross(p - a)) >= 0.0 && n.dot((c - b).cross(p - b)) >= 0.0 &&
                         n.dot((a - c).cross(p - c)) >= 0.0;
  if (over_face) return n.dot(p - a) * n.dot(p - a) / n.squaredNorm();
  return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                   squared_distance_to_segment(p, c, a)});
}

bool TriangleTree::comes_within(const Vector3d& p, double reach) const {
  std::vector<std::uint32_t> todo{0};
  while (!todo.empty()) {
    const Node& node = nodes_[todo.back()];
    todo.pop_back();
    if (node.box.squaredExteriorDistance(p) >= reach * reach) continue;
    if (node.count == 0) {
      todo.push_back(node.first);
      todo.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (squared_distance(p, order_[i]) < reach * reach) return true;
  }
  return false;
}

}  // namespace penumbra::offset
