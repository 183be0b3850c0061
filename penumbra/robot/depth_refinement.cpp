// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <vector>

#include <penumbra/robot/depth_refinement-inl.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

class Refiner {
 public:
  Refiner(TriangleMesh& mesh, const TriangleTree& surface, const DepthBounds& bounds)
      : mesh_(mesh), surface_(surface), bounds_(bounds) {}

  bool run(int passes) {
    std::vector<std::uint32_t> doubtful(mesh_.triangles.size());
    std::iota(doubtful.begin(), doubtful.end(), 0U);
    for (int pass = 0;; ++pass) {
      mark(doubtful);
      if (middles_.empty()) return true;
      if (pass == passes) return false;
      doubtful = split();
    }
  }

 private:
  [[nodiscard]] Vector3d corner(std::uint32_t vertex) const {
    return mesh_.vertices[vertex].cast<double>();
  }

  [[nodiscard]] bool fits(const Vector3d& p) const {
    return (surface_.nearest(p, bounds_.most) - p).norm() >= bounds_.least;
  }

  /// Collects the sides to split.
  void mark(const std::vector<std::uint32_t>& doubtful) {
    middles_.clear();
    for (const std::uint32_t i : doubtful) {
      const auto& t = mesh_.triangles[i];
      const bool whole = !fits((corner(t[0]) + corner(t[1]) + corner(t[2])) / 3.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        const bool twin_looks = a > b;
        if (whole || (!twin_looks && !fits((corner(a) + corner(b)) / 2.0)))
          middles_.try_emplace(edge_key(a, b), 0U);
      }
    }
  }

  [[nodiscard]] Eigen::Vector3f moved_to_depth(Vector3d p) const {
    constexpr int steps = 3;
    for (int i = 0; i < steps; ++i) {
      const Vector3d q = surface_.nearest(p, 4.0 * bounds_.most);
      p = q + bounds_.depth * (p - q).stableNormalized();
    }
    return p.cast<float>();
  }

  /// Splits the sides collected; the triangles that are new.
  std::vector<std::uint32_t> split() {
    std::vector<std::uint32_t> fresh;
    const std::size_t count = mesh_.triangles.size();
    for (std::uint32_t i = 0; i < count; ++i) {
      auto t = mesh_.triangles[i];
      std::array<std::uint32_t, 3> middle{};
      std::size_t n = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        middle[k] = middle_of(t[k], t[(k + 1) % 3]);
        n += middle[k] != 0 ? 1 : 0;
      }
      if (n == 0) continue;
      while (middle[0] == 0 || (n == 2 && middle[1] == 0)) {
        std::rotate(t.begin(), t.begin() + 1, t.end());
        std::rotate(middle.begin(), middle.begin() + 1, middle.end());
      }
      fresh.push_back(i);
      const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
      replace(i, t, middle, n);
      for (auto j = first; j < mesh_.triangles.size(); ++j) fresh.push_back(j);
    }
    return fresh;
  }

  /// The new vertex of a side; 0 where it is not split: vertex 0 is an old one.
  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) {
    const auto found = middles_.find(edge_key(a, b));
    if (found == middles_.end()) return 0;
    if (found->second == 0) {
      found->second = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(moved_to_depth((corner(a) + corner(b)) / 2.0));
    }
    return found->second;
  }

  /// Puts the parts of triangle t, whose first n sides are split, in place of it.
  void replace(std::uint32_t i, const std::array<std::uint32_t, 3>& t,
               const std::array<std::uint32_t, 3>& middle, std::size_t n) {
    const auto put = [this](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh_.triangles.push_back({a, b, c});
    };
    if (n == 1) {
      mesh_.triangles[i] = {t[0], middle[0], t[2]};
      put(middle[0], t[1], t[2]);
      return;
    }
    mesh_.triangles[i] = {middle[0], t[1], middle[1]};
    if (n == 2) {
      put(t[0], middle[0], middle[1]);
      put(t[0], middle[1], t[2]);
      return;
    }
    put(t[0], middle[0], middle[2]);
    put(middle[2], middle[1], t[2]);
    put(middle[0], middle[1], middle[2]);
  }

  TriangleMesh& mesh_;
  const TriangleTree& surface_;
  DepthBounds bounds_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

}  // namespace

bool keeps_depth(const TriangleMesh& mesh, const TriangleTree& surface, const DepthBounds& bounds) {
  TriangleMesh unchanged = mesh;
  return Refiner(unchanged, surface, bounds).run(0);
}

bool refine_to_depth(TriangleMesh& mesh, const TriangleTree& surface, const DepthBounds& bounds) {
  constexpr int passes = 5;
  return Refiner(mesh, surface, bounds).run(passes);
}

}  // namespace penumbra::offset
