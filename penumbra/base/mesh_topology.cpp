// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include <penumbra/base/mesh_topology.hpp>

namespace penumbra {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::uint32_t none = ~std::uint32_t{0};

std::uint32_t hash_position(const Eigen::Vector3f& p) {
  std::uint64_t h = 0x9E3779B97F4A7C15u;
  for (int axis = 0; axis < 3; ++axis) {
    h = (h ^ std::bit_cast<std::uint32_t>(p[axis])) * 0xFF51AFD7ED558CCDu;
    h ^= h >> 32;
  }
  return static_cast<std::uint32_t>(h);
}

/// Numbers positions in the order in which they are met: open addressing, at most half full.
class PositionIndex {
 public:
  explicit PositionIndex(std::size_t most) : slots_(std::bit_ceil(2 * most + 2), none) {}

  std::uint32_t find_or_add(Eigen::Vector3f position, std::vector<Eigen::Vector3f>& vertices) {
    position.array() += 0.0F;  // -0.0 becomes 0.0
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash_position(position) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == none) {
        slots_[slot] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(position);
        return slots_[slot];
      }
      if (vertices[slots_[slot]] == position) return slots_[slot];
    }
  }

 private:
  std::vector<std::uint32_t> slots_;
};

bool has_equal_corners(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool has_area(const std::vector<Eigen::Vector3f>& vertices, const Triangle& t) {
  const Eigen::Vector3d a = vertices[t[0]].cast<double>();
  const Eigen::Vector3d ab = vertices[t[1]].cast<double>() - a;
  const Eigen::Vector3d ac = vertices[t[2]].cast<double>() - a;
  return !ab.cross(ac).isZero(0.0);
}

/// Removes triangles of zero area so that no piece opens: the neighbour across a sliver's longest
/// edge is split where the sliver's third corner lies on that edge.
class SliverRemover {
 public:
  explicit SliverRemover(TriangleMesh& mesh) : mesh_(mesh) {}

  void run() {
    constexpr int passes = 16;  // a split may leave slivers on the next longer edge
    for (int pass = 0; pass < passes && find_slivers(); ++pass) {
      index_edges();
      for (const std::uint32_t i : slivers_) remove(i);
      std::erase_if(mesh_.triangles, has_equal_corners);
    }
    std::erase_if(mesh_.triangles,
                  [this](const Triangle& t) { return !has_area(mesh_.vertices, t); });
  }

 private:
  static constexpr Triangle dead{0, 0, 0};

  static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32 | to;
  }

  bool find_slivers() {
    slivers_.clear();
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      if (!has_area(mesh_.vertices, mesh_.triangles[i])) slivers_.push_back(i);
    return !slivers_.empty();
  }

  /// Edges between corners of slivers; `none` where several triangles run one.
  void index_edges() {
    std::vector<bool> is_corner(mesh_.vertices.size(), false);
    for (const std::uint32_t i : slivers_)
      for (const std::uint32_t corner : mesh_.triangles[i]) is_corner[corner] = true;
    triangle_of_.clear();
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t to = t[(k + 1) % 3];
        if (!is_corner[t[k]] || !is_corner[to]) continue;
        const auto [entry, is_new] = triangle_of_.emplace(key(t[k], to), i);
        if (!is_new) entry->second = none;
      }
    }
  }

  /// The sliver turned so that its longest edge comes first.
  [[nodiscard]] Triangle longest_first(Triangle t) const {
    const auto length = [this](std::uint32_t a, std::uint32_t b) {
      return (mesh_.vertices[a] - mesh_.vertices[b]).cast<double>().squaredNorm();
    };
    while (length(t[0], t[1]) < length(t[1], t[2]) || length(t[0], t[1]) < length(t[2], t[0]))
      std::rotate(t.begin(), t.begin() + 1, t.end());
    return t;
  }

  void remove(std::uint32_t i) {
    if (mesh_.triangles[i] == dead) return;
    const auto [p, q, r] = longest_first(mesh_.triangles[i]);
    const auto found = triangle_of_.find(key(q, p));
    mesh_.triangles[i] = dead;
    if (found == triangle_of_.end() || found->second == none) return;  // it closed nothing
    const std::uint32_t neighbour = found->second;
    const Triangle across = mesh_.triangles[neighbour];
    const std::size_t k =
        static_cast<std::size_t>(std::find(across.begin(), across.end(), q) - across.begin());
    if (k == 3 || across[(k + 1) % 3] != p) return;  // it was split itself, in this pass
    const std::uint32_t d = across[(k + 2) % 3];
    mesh_.triangles[neighbour] = dead;
    if (d == r) return;  // two slivers back to back
    replace(neighbour, {q, r, d});
    replace(i, {r, p, d});
  }

  void replace(std::uint32_t i, const Triangle& t) {
    mesh_.triangles[i] = t;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = triangle_of_.find(key(t[k], t[(k + 1) % 3]));
      if (edge != triangle_of_.end() && edge->second != none) edge->second = i;
    }
  }

  TriangleMesh& mesh_;
  std::vector<std::uint32_t> slivers_;
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_of_;
};

/// A triangle's run along an edge, seen from the edge's lower vertex.
struct EdgeUse {
  std::uint32_t upper;     // the edge's higher vertex
  std::uint32_t triangle;  // 2 * index, + 1 where it runs from the higher to the lower vertex
};

/// Every use of every edge, grouped by lower vertex; first[v] .. first[v + 1] are those of v.
struct EdgeUses {
  std::vector<std::uint32_t> first;
  std::vector<EdgeUse> uses;
};

EdgeUses collect_edges(const TriangleMesh& mesh) {
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

/// Calls f(uses of one edge) for every edge.
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
      f(run, next);
      run = next;
    }
  }
}

/// Disjoint sets of triangles; a set is named by its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

double signed_volume(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  // Seen from a point of the component: cancels less than seen from a far origin.
  const Eigen::Vector3d eye =
      mesh.vertices[mesh.triangles[triangles.front()].front()].cast<double>();
  double six_volumes = 0.0;
  for (const std::size_t i : triangles) {
    const Triangle& t = mesh.triangles[i];
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>() - eye;
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>() - eye;
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>() - eye;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

}  // namespace

TriangleMesh weld(const TriangleMesh& mesh) {
  const std::size_t most = std::min(mesh.vertices.size(), 3 * mesh.triangles.size());
  TriangleMesh welded;
  welded.vertices.reserve(most);
  welded.triangles.reserve(mesh.triangles.size());

  PositionIndex positions(most);
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), none);
  for (const Triangle& given : mesh.triangles) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& number = renumbered[given[k]];
      if (number == none) number = positions.find_or_add(mesh.vertices[given[k]], welded.vertices);
      t[k] = number;
    }
    if (!has_equal_corners(t)) welded.triangles.push_back(t);
  }
  SliverRemover(welded).run();
  return welded;
}

std::vector<MeshComponent> connected_components(const TriangleMesh& welded) {
  EdgeUses edges = collect_edges(welded);
  DisjointSets sets(welded.triangles.size());
  std::vector<bool> open(welded.triangles.size(), false);
  for_each_edge(edges, [&](const EdgeUse* begin, const EdgeUse* end) {
    const bool closed = end - begin == 2 && (begin[0].triangle & 1) != (begin[1].triangle & 1);
    if (!closed) open[begin->triangle / 2] = true;
    for (const EdgeUse* use = begin + 1; use < end; ++use)
      sets.join(begin->triangle / 2, use->triangle / 2);
  });

  std::vector<MeshComponent> components;
  std::vector<std::uint32_t> component_of(welded.triangles.size(), none);
  for (std::uint32_t i = 0; i < welded.triangles.size(); ++i) {
    std::uint32_t& number = component_of[sets.find(i)];
    if (number == none) {
      number = static_cast<std::uint32_t>(components.size());
      components.push_back({{}, true, 0.0});
    }
    components[number].triangles.push_back(i);
    if (open[i]) components[number].closed = false;
  }
  for (MeshComponent& component : components)
    component.signed_volume = signed_volume(welded, component.triangles);
  return components;
}

bool is_watertight(const TriangleMesh& welded) {
  const std::vector<MeshComponent> components = connected_components(welded);
  return !components.empty() && std::all_of(components.begin(), components.end(),
                                            [](const MeshComponent& c) { return c.closed; });
}

}  // namespace penumbra
