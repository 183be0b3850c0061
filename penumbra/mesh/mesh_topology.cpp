// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include <penumbra/mesh/mesh_edges-inl.hpp>
#include <penumbra/mesh/mesh_topology.hpp>

namespace penumbra {
namespace {

constexpr std::uint32_t nothing = ~std::uint32_t{0};

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
  explicit PositionIndex(std::size_t most) : slots_(std::bit_ceil(2 * most + 2), nothing) {}

  std::uint32_t find_or_add(Eigen::Vector3f position, std::vector<Eigen::Vector3f>& vertices) {
    position.array() += 0.0F;  // -0.0 becomes 0.0
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash_position(position) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == nothing) {
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

  /// Edges between corners of slivers; `nothing` where several triangles run one.
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
        if (!is_new) entry->second = nothing;
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
    if (found == triangle_of_.end() || found->second == nothing) return;  // it closed nothing
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
      if (edge != triangle_of_.end() && edge->second != nothing) edge->second = i;
    }
  }

  TriangleMesh& mesh_;
  std::vector<std::uint32_t> slivers_;
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_of_;
};

}  // namespace

TriangleMesh weld(const TriangleMesh& mesh) {
  const std::size_t most = std::min(mesh.vertices.size(), 3 * mesh.triangles.size());
  TriangleMesh welded;
  welded.vertices.reserve(most);
  welded.triangles.reserve(mesh.triangles.size());

  PositionIndex positions(most);
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), nothing);
  for (const Triangle& given : mesh.triangles) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& number = renumbered[given[k]];
      if (number == nothing)
        number = positions.find_or_add(mesh.vertices[given[k]], welded.vertices);
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
  for_each_edge(edges, [&](std::uint32_t /*lower*/, const EdgeUse* begin, const EdgeUse* end) {
    if (!is_regular(begin, end)) open[begin->triangle / 2] = true;
    for (const EdgeUse* use = begin + 1; use < end; ++use)
      sets.join(begin->triangle / 2, use->triangle / 2);
  });

  std::vector<MeshComponent> components;
  for (std::vector<std::size_t>& triangles : sets.members()) {
    MeshComponent& component = components.emplace_back();
    component.closed =
        std::none_of(triangles.begin(), triangles.end(), [&](std::size_t i) { return open[i]; });
    component.signed_volume =
        signed_volume(welded, triangles, corners_of(welded, triangles.front())[0]);
    component.triangles = std::move(triangles);
  }
  return components;
}

bool is_watertight(const TriangleMesh& welded) {
  const std::vector<MeshComponent> components = connected_components(welded);
  return !components.empty() && std::all_of(components.begin(), components.end(),
                                            [](const MeshComponent& c) { return c.closed; });
}

}  // namespace penumbra
