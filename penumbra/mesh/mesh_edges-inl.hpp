// SPDX-License-Identifier: Apache-2.0
// Edges of a mesh and who runs along them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

using Triangle = std::array<std::uint32_t, 3>;

/// A triangle's run along an edge, seen from the edge's lower vertex.
struct EdgeUse {
  std::uint32_t upper;     // the edge's higher vertex
  std::uint32_t triangle;  // 2 * index, + 1 where it runs from the higher to the lower vertex
};

/// Whether exactly two triangles share the edge and run it in opposite ways: one's front then goes
/// on as the other's.
inline bool is_regular(const EdgeUse* begin, const EdgeUse* end) {
  return end - begin == 2 && (begin[0].triangle & 1) != (begin[1].triangle & 1);
}

/// Every use of every edge, grouped by lower vertex; first[v] .. first[v + 1] are those of v.
struct EdgeUses {
  std::vector<std::uint32_t> first;
  std::vector<EdgeUse> uses;
};

inline EdgeUses collect_edges(const TriangleMesh& mesh) {
  EdgeUses edges;
  edges.first.assign(mesh.vertices.size() + 2, 0);
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges.first[std::min(t[k], t[(k + 1) % 3]) + 2];
  std::partial_sum(edges.first.begin(), edges.first.end(), edges.first.begin());

  edges.uses.resize(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k];
      const std::uint32_t to = mesh.triangles[i][(k + 1) % 3];
      const std::uint32_t at = edges.first[std::min(from, to) + 1]++;
      edges.uses[at] = {std::max(from, to), 2 * i + (from > to ? 1U : 0U)};
    }
  }
  edges.first.pop_back();
  return edges;
}

/// Calls f(lower vertex, begin, end of the uses) for every edge.
template <typename F>
void for_each_edge(EdgeUses& edges, F&& f) {
  for (std::size_t v = 0; v + 1 < edges.first.size(); ++v) {
    EdgeUse* const begin = edges.uses.data() + edges.first[v];
    EdgeUse* const end = edges.uses.data() + edges.first[v + 1];
    std::sort(begin, end, [](const EdgeUse& a, const EdgeUse& b) {
      return std::pair(a.upper, a.triangle) < std::pair(b.upper, b.triangle);
    });
    for (EdgeUse* run = begin; run != end;) {
      EdgeUse* next = run + 1;
      while (next != end && next->upper == run->upper) ++next;
      f(static_cast<std::uint32_t>(v), run, next);
      run = next;
    }
  }
}

/// Disjoint sets of numbers; a set is named by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// The sets' members in rising order; the sets ordered by their first.
  std::vector<std::vector<std::size_t>> members() {
    std::vector<std::vector<std::size_t>> sets;
    std::vector<std::size_t> number(parent_.size());
    for (std::uint32_t i = 0; i < parent_.size(); ++i) {
      if (find(i) == i) {
        number[i] = sets.size();
        sets.emplace_back();
      }
      sets[number[find(i)]].push_back(i);
    }
    return sets;
  }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Returns whether they were apart.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The triangle's corners.
inline std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(),
          mesh.vertices[c].cast<double>()};
}

/// Volume between some triangles and `eye`, with its sign, cubic metres. Of closed pieces it is the
/// same for every eye, and rounds least for a near one.
inline double signed_volume(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles,
                            const Eigen::Vector3d& eye) {
  double sum = 0.0;
  for (const std::size_t i : triangles) {
    const auto [a, b, c] = corners_of(mesh, i);
    sum += (a - eye).dot((b - eye).cross(c - eye));
  }
  return sum / 6.0;
}

}  // namespace penumbra
