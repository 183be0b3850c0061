// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

#include <Eigen/Geometry>

#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/offset_sides-inl.hpp>

namespace penumbra::offset {
namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;

/// A triangle at an edge, seen along the edge from its lower to its higher vertex.
struct Leaf {
  std::uint32_t lower;
  std::uint32_t higher;
  std::uint32_t plus;   // half-edge of the side that looks counter-clockwise; none if not free
  std::uint32_t minus;  // half-edge of the side that looks clockwise
  double angle = 0.0;
};

class Gluer {
 public:
  explicit Gluer(const TriangleMesh& mesh) : mesh_(mesh) {}

  MeshSides run() {
    for (const MeshComponent& piece : connected_components(mesh_)) {
      for (const std::size_t i : piece.triangles) {
        const bool front = !piece.closed || piece.signed_volume >= 0.0;
        const bool back = !piece.closed || piece.signed_volume < 0.0;
        add_triangle(mesh_.triangles[i], front, back);
      }
    }
    sides_.twin.resize(sides_.start.size(), none);
    sides_.middle.resize(sides_.start.size());
    std::sort(leaves_.begin(), leaves_.end(), [](const Leaf& a, const Leaf& b) {
      return std::tuple(a.lower, a.higher) < std::tuple(b.lower, b.higher);
    });
    for (std::size_t i = 0; i < leaves_.size();) {
      std::size_t end = i + 1;
      while (end < leaves_.size() && leaves_[end].lower == leaves_[i].lower &&
             leaves_[end].higher == leaves_[i].higher)
        ++end;
      glue_edge({leaves_.data() + i, end - i});
      i = end;
    }
    return std::move(sides_);
  }

 private:
  [[nodiscard]] Eigen::Vector3d point(std::uint32_t v) const {
    return mesh_.vertices[v].cast<double>();
  }

  std::uint32_t add_side(const std::array<std::uint32_t, 3>& t) {
    const auto first = static_cast<std::uint32_t>(sides_.start.size());
    sides_.start.insert(sides_.start.end(), t.begin(), t.end());
    const Eigen::Vector3d a = point(t[0]);
    sides_.normal.push_back((point(t[1]) - a).cross(point(t[2]) - a).stableNormalized());
    return first;
  }

  void add_triangle(const std::array<std::uint32_t, 3>& t, bool front, bool back) {
    const std::uint32_t front_side = front ? add_side(t) : none;
    const std::uint32_t back_side = back ? add_side({t[0], t[2], t[1]}) : none;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      const std::uint32_t in_front = front ? front_side + k : none;
      const std::uint32_t in_back = back ? back_side + 2 - k : none;
      // A front that runs from the lower to the higher vertex looks counter-clockwise.
      if (from < to)
        leaves_.push_back({from, to, in_front, in_back});
      else
        leaves_.push_back({to, from, in_back, in_front});
    }
  }

  void glue_edge(std::span<Leaf> leaves) {
    const Eigen::Vector3d lower = point(leaves[0].lower);
    const Eigen::Vector3d axis = (point(leaves[0].higher) - lower).stableNormalized();
    const Eigen::Vector3d x = axis.unitOrthogonal();
    const Eigen::Vector3d y = axis.cross(x);
    for (Leaf& leaf : leaves) {
      const std::uint32_t h = leaf.plus != none ? leaf.plus : leaf.minus;
      const Eigen::Vector3d out = point(sides_.start[MeshSides::previous(h)]) - lower;
      leaf.angle = std::atan2(out.dot(y), out.dot(x));
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
      return std::tuple(a.angle, a.plus) < std::tuple(b.angle, b.plus);
    });
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const Leaf& a = leaves[i];
      if (a.plus == none) continue;
      const bool last = i + 1 == leaves.size();
      const Leaf& b = leaves[last ? 0 : i + 1];
      double wedge = b.angle - a.angle + (last ? full_turn : 0.0);
      const bool front_only = a.minus == none;
      if (front_only && wedge == 0.0) wedge = full_turn;  // a closed piece without thickness
      const double half = a.angle + wedge / 2.0;
      glue(a.plus, b.minus, x * std::cos(half) + y * std::sin(half));
    }
  }

  void glue(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& middle) {
    sides_.twin[a] = b;
    sides_.twin[b] = a;
    sides_.middle[a] = sides_.middle[b] = middle.cast<float>();
  }

  const TriangleMesh& mesh_;
  MeshSides sides_;
  std::vector<Leaf> leaves_;
};

}  // namespace

MeshSides collect_sides(const TriangleMesh& welded) { return Gluer(welded).run(); }

}  // namespace penumbra::offset
