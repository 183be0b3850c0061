// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>
#include <meshoptimizer.h>

#include <penumbra/mesh/weld.hpp>

namespace penumbra {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::uint32_t nothing = ~std::uint32_t{0};

bool has_equal_corners(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool has_area(const std::vector<Eigen::Vector3f>& vertices, const Triangle& t) {
  const Eigen::Vector3d a = vertices[t[0]].cast<double>();
  const Eigen::Vector3d ab = vertices[t[1]].cast<double>() - a;
  const Eigen::Vector3d ac = vertices[t[2]].cast<double>() - a;
  return !ab.cross(ac).isZero(0.0);
}

/// Removes triangles of zero area (slivers) and closes the gap: splits the neighbour across a
/// sliver's longest edge at the sliver's third corner, which lies on that edge.
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

  /// Finds the triangle of each edge between corners of slivers; `nothing` if there are several.
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

  /// Rotates a sliver so that its longest edge comes first.
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
    if (found == triangle_of_.end() || found->second == nothing) return;  // it has no neighbour
    const std::uint32_t neighbour = found->second;
    const Triangle across = mesh_.triangles[neighbour];
    const std::size_t k =
        static_cast<std::size_t>(std::find(across.begin(), across.end(), q) - across.begin());
    if (k == 3 || across[(k + 1) % 3] != p) return;  // this pass has already split it
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
  if (mesh.triangles.empty()) return {};
  std::vector<Eigen::Vector3f> vertices = mesh.vertices;
  for (Eigen::Vector3f& vertex : vertices) vertex.array() += 0.0F;  // -0.0 becomes 0.0
  const std::size_t stride = sizeof(Eigen::Vector3f);
  std::vector<std::uint32_t> numbers(vertices.size());
  TriangleMesh welded;
  welded.vertices.resize(meshopt_generateVertexRemap(numbers.data(), mesh.triangles.front().data(),
                                                     3 * mesh.triangles.size(), vertices.data(),
                                                     vertices.size(), stride));
  meshopt_remapVertexBuffer(welded.vertices.data(), vertices.data(), vertices.size(), stride,
                            numbers.data());
  welded.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t{numbers[a], numbers[b], numbers[c]};
    if (!has_equal_corners(t)) welded.triangles.push_back(t);
  }
  SliverRemover(welded).run();
  return welded;
}

}  // namespace penumbra
