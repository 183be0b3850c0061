// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <mutex>
#include <numeric>

#include <penumbra/mesh/prepared_mesh.hpp>
#include <penumbra/mesh/surface_patches.hpp>
#include <penumbra/mesh/weld.hpp>

namespace penumbra {
namespace {

/// A triangle's use of an edge.
struct EdgeUse {
  std::uint32_t lower, upper;  // vertices
  std::uint32_t triangle;
  bool falls;  // it runs from the upper vertex to the lower one

  auto operator<=>(const EdgeUse&) const = default;
};

/// Returns all uses, sorted: by their lower vertices in linear time, then each vertex's few uses.
std::vector<EdgeUse> edges_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> end(mesh.vertices.size() + 1);  // of each lower vertex's uses
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++end[std::min(t[k], t[(k + 1) % 3]) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<EdgeUse> uses(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[i][k];
      const std::uint32_t to = mesh.triangles[i][(k + 1) % 3];
      const std::uint32_t lower = std::min(from, to);
      uses[end[lower]++] = {lower, std::max(from, to), i, from > to};
    }
  }
  auto begin = uses.begin();
  for (const std::uint32_t last : end) {
    std::sort(begin, uses.begin() + last);
    begin = uses.begin() + last;
  }
  return uses;
}

Connections connect(const TriangleMesh& mesh) {
  const std::vector<EdgeUse> uses = edges_of(mesh);
  Connections connections;
  for (auto begin = uses.begin(), end = begin; begin != uses.end(); begin = end) {
    const auto is_other_edge = [&](const EdgeUse& use) {
      return use.lower != begin->lower || use.upper != begin->upper;
    };
    end = std::find_if(begin, uses.end(), is_other_edge);
    if (end - begin == 2 && begin[0].falls != begin[1].falls) {
      connections.regular.emplace_back(begin[0].triangle, begin[1].triangle);
      continue;
    }
    for (auto use = begin; use != end; ++use)
      connections.rim.push_back({use->triangle, use->falls ? use->upper : use->lower,
                                 use->falls ? use->lower : use->upper});
  }
  return connections;
}

std::vector<SurfacePatch> split(const TriangleMesh& mesh, const Connections& connections) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  DisjointSets sets(count);
  for (const auto& [a, b] : connections.regular) sets.join(a, b);
  std::vector<SurfacePatch> patches;
  std::vector<std::size_t> number(count);  // of the patch that a set's first triangle begins
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t first = sets.find(i);
    if (first == i) {
      number[i] = patches.size();
      patches.emplace_back().closed = true;
    }
    SurfacePatch& patch = patches[number[first]];
    patch.triangles.push_back(i);
    for (const Eigen::Vector3d& corner : corners_of(mesh, i)) patch.bounds.extend(corner);
  }
  for (const RimEdge& edge : connections.rim)
    patches[number[sets.find(edge.triangle)]].closed = false;
  return patches;
}

}  // namespace

struct PreparedMesh::Orientations {
  Connections connections;  // until `found`
  std::once_flag found;
  std::vector<PatchOrientation> of_patches;
};

PreparedMesh::PreparedMesh(const TriangleMesh& mesh)
    : TriangleMesh(weld(mesh)), orientations_(std::make_shared<Orientations>()) {
  Connections& connections = orientations_->connections;
  connections = connect(*this);
  patches = split(*this, connections);
  for (const SurfacePatch& patch : patches) bounds.extend(patch.bounds);
  watertight = !patches.empty() && connections.rim.empty();
}

const std::vector<PatchOrientation>& PreparedMesh::orientations() const {
  Orientations& shared = *orientations_;
  std::call_once(shared.found, [&] {
    shared.of_patches = orient(*this, shared.connections);
    shared.connections = {};
  });
  return shared.of_patches;
}

}  // namespace penumbra
