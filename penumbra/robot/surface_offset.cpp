// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include <penumbra/base/error.hpp>
#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/robot/offset_burial-inl.hpp>
#include <penumbra/robot/offset_cleanup-inl.hpp>
#include <penumbra/robot/offset_directions-inl.hpp>
#include <penumbra/robot/offset_sides-inl.hpp>
#include <penumbra/robot/surface_erosion-inl.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra {
namespace {

using offset::along;
using offset::angle_between;
using offset::Cap;
using offset::drop_returns;
using offset::MeshSides;
using offset::none;

// Every face of the result spans corners p + margin * u of unit u. It lies inside of the balls'
// hull, and inside of the exact surface by at most margin * (1 - cos(r)), if all of its u lie
// within r of the true normal: `reach`. Shares of it go to the merging of normals and to arcs.
const double reach = std::acos(1.0 - offset_error);
const double merging = 0.6 * reach;    // between a face's normal and the u of its corners
const double arc_step = 1.2 * reach;   // between neighbouring u of an arc, twice its own share
const double ring_step = 1.1 * reach;  // between rings of a patch

/// Moves the faces of `sides` out, puts strips of arcs between them at sharp edges and patches of
/// spheres at corners. Each new vertex is an old one plus margin times a unit vector.
class Grower {
 public:
  Grower(const TriangleMesh& mesh, double margin)
      : mesh_(mesh), margin_(margin), sides_(offset::collect_sides(mesh)), burial_(mesh, margin) {
    moved_.assign(sides_.start.size(), none);
    arcs_.resize(sides_.start.size());
  }

  TriangleMesh run() {
    for (std::uint32_t h = 0; h < sides_.start.size(); ++h)
      if (moved_[h] == none) grow_vertex(h);
    for (std::uint32_t h = 0; h < sides_.start.size(); h += 3)
      add(moved_[h], moved_[h + 1], moved_[h + 2]);
    for (std::uint32_t h = 0; h < sides_.start.size(); ++h)
      if (h < sides_.twin[h]) add_strip(h);
    return std::move(result_);
  }

 private:
  using Chain = std::vector<std::uint32_t>;

  [[nodiscard]] const Eigen::Vector3d& normal(std::uint32_t h) const {
    return sides_.normal[h / 3];
  }

  std::uint32_t add_vertex(std::uint32_t origin, const Eigen::Vector3d& u) {
    const Eigen::Vector3d p = mesh_.vertices[origin].cast<double>() + margin_ * u;
    result_.vertices.push_back(p.cast<float>());
    directions_.push_back(u);
    return static_cast<std::uint32_t>(result_.vertices.size() - 1);
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) result_.triangles.push_back({a, b, c});
  }

  /// The half-edges that leave a vertex, counter-clockwise seen from outside, beginning behind the
  /// sharpest edge.
  Chain fan_of(std::uint32_t first) const {
    Chain fan;
    double sharpest = 2.0;
    std::size_t begin = 0;
    std::uint32_t h = first;
    do {
      const double cosine = normal(h).dot(normal(sides_.twin[h]));
      if (cosine < sharpest) {
        sharpest = cosine;
        begin = fan.size();
      }
      fan.push_back(h);
      h = sides_.twin[MeshSides::previous(h)];
    } while (h != first);
    std::rotate(fan.begin(), fan.begin() + static_cast<std::ptrdiff_t>(begin), fan.end());
    return fan;
  }

  /// The vertex of one of the fan's first `done` corners that moved the same way, or a new one.
  std::uint32_t find_or_add(const Chain& fan, std::size_t done, const Eigen::Vector3d& u) {
    constexpr std::size_t many = 64;  // quadratic time ends here
    constexpr double same = 1e-6;     // metres in a metre: floats may not tell them apart
    for (std::size_t i = 0; i < std::min(done, many); ++i)
      if ((directions_[moved_[fan[i]]] - u).norm() < same) return moved_[fan[i]];
    return add_vertex(sides_.start[fan.front()], u);
  }

  /// Gives neighbouring corners of nearly equal normals one common new vertex.
  void merge_corners(const Chain& fan) {
    for (std::size_t i = 0; i < fan.size();) {
      Cap cap{normal(fan[i])};
      std::size_t end = i + 1;
      while (end < fan.size() && cap.add(normal(fan[end]), merging)) ++end;
      const std::uint32_t vertex = find_or_add(fan, i, cap.centre);
      for (; i < end; ++i) moved_[fan[i]] = vertex;
    }
  }

  void grow_vertex(std::uint32_t first) {
    const Chain fan = fan_of(first);
    merge_corners(fan);
    Chain sharp;  // the half-edges of the fan whose two sides got vertices of their own
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const std::uint32_t before = moved_[fan[(i + fan.size() - 1) % fan.size()]];
      arcs_[fan[i]] = {before};
      if (before != moved_[fan[i]]) sharp.push_back(fan[i]);
    }
    const bool farthest = can_be_farthest(sharp) && !is_buried(fan, sharp);
    Chain loop;
    for (std::size_t i = 0; i < sharp.size(); ++i) {
      Chain& arc = arcs_[sharp[i]];
      make_arc(sharp[i], {sharp.data(), i}, farthest);
      loop.insert(loop.end(), arc.begin(), arc.end() - 1);
    }
    drop_returns(loop);
    if (loop.size() > 2) add_patch(fan, loop, farthest);
  }

  [[nodiscard]] Eigen::Vector3d direction_of(std::uint32_t h) const {
    return (mesh_.vertices[sides_.start[MeshSides::next(h)]] - mesh_.vertices[sides_.start[h]])
        .cast<double>()
        .stableNormalized();
  }

  /// Whether there is a direction in which no edge of a fan goes on: only then is a part of the
  /// vertex's ball on the exact surface. Its cone, if any, has an edge that is normal to two edges.
  [[nodiscard]] bool can_be_farthest(const Chain& sharp) const {
    constexpr std::size_t many = 24;  // not worth the search
    if (sharp.size() < 3 || sharp.size() > many) return true;
    std::vector<Eigen::Vector3d> edges;
    for (const std::uint32_t h : sharp) edges.push_back(direction_of(h));
    const auto ends_all = [&edges](const Eigen::Vector3d& u) {
      constexpr double doubt = 1e-3;
      return std::all_of(edges.begin(), edges.end(),
                         [&u](const Eigen::Vector3d& e) { return e.dot(u) <= doubt; });
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Eigen::Vector3d u = edges[i].cross(edges[j]).stableNormalized();
        if (u.isZero() || ends_all(u) || ends_all(-u)) return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool is_buried(const Chain& fan, const Chain& sharp) const {
    if (sharp.size() < 3) return false;  // no patch
    std::vector<Eigen::Vector3d> normals;
    for (const std::uint32_t h : fan) normals.push_back(normal(h));
    return burial_.hides_corner(mesh_.vertices[sides_.start[fan.front()]].cast<double>(),
                                patch_centre(fan), normals);
  }

  [[nodiscard]] bool is_buried(std::uint32_t h) const {
    return burial_.hides_edge(mesh_.vertices[sides_.start[h]].cast<double>(),
                              mesh_.vertices[sides_.start[MeshSides::next(h)]].cast<double>(),
                              normal(h), normal(sides_.twin[h]));
  }

  [[nodiscard]] bool is_concave(std::uint32_t h) const {
    const Eigen::Vector3d into = direction_of(MeshSides::previous(sides_.twin[h])) * -1.0;
    return into.dot(normal(h)) > 1e-3;
  }

  /// Completes the arc at the start of sharp half-edge h, from the new vertex of the side across h
  /// to that of its own side. A concave edge owns nothing of the exact surface: a chord is enough,
  /// but where a patch that does ends at it.
  void make_arc(std::uint32_t h, std::span<const std::uint32_t> made, bool fine) {
    Chain& arc = arcs_[h];
    const std::uint32_t from = arc.front();
    const std::uint32_t to = moved_[h];
    constexpr double short_way_is_clear = 0.45 * std::numbers::pi;
    const Eigen::Vector3d a = directions_[from];
    const Eigen::Vector3d b = directions_[to];
    const bool exact = fine || !(is_concave(h) || is_buried(h));
    const double step = exact ? arc_step : std::numbers::pi;
    if (angle_between(a, b) > short_way_is_clear) {
      const Eigen::Vector3d middle = sides_.middle[h].cast<double>().normalized();
      append_arc(a, middle, h, step);
      arc.push_back(add_vertex(sides_.start[h], middle));
      append_arc(middle, b, h, step);
    } else {
      // The way back along an arc that is there shares its vertices: no patch is left between.
      for (const std::uint32_t other : made) {
        const Chain& twin = arcs_[other];
        if (twin.front() != to || twin.back() != from) continue;
        arc.assign(twin.rbegin(), twin.rend());
        return;
      }
      append_arc(a, b, h, step);
    }
    arc.push_back(to);
  }

  void append_arc(const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::uint32_t h,
                  double step) {
    const int steps = static_cast<int>(std::ceil(angle_between(a, b) / step));
    for (int i = 1; i < steps; ++i)
      arcs_[h].push_back(add_vertex(sides_.start[h], along(a, b, static_cast<double>(i) / steps)));
  }

  /// Fills the loop: ears as long as they are small, then rings inwards with ears cut off each.
  void add_patch(const Chain& fan, Chain loop, bool farthest) {
    const std::uint32_t origin = sides_.start[fan.front()];
    cut_ears(loop);
    if (farthest && loop.size() > 2) {
      const Eigen::Vector3d centre = patch_centre(fan);
      while (loop.size() > 2 && widest_angle(centre, loop) > ring_step) {
        add_ring(origin, centre, loop);
        cut_ears(loop);
      }
      if (loop.size() > 3) {
        const std::uint32_t middle = add_vertex(origin, centre);
        for (std::size_t i = 0; i < loop.size(); ++i)
          add(middle, loop[i], loop[(i + 1) % loop.size()]);
        return;
      }
    }
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) add(loop[0], loop[i], loop[i + 1]);
  }

  [[nodiscard]] double widest_angle(const Eigen::Vector3d& centre, const Chain& loop) const {
    double widest = 0.0;
    for (const std::uint32_t v : loop)
      widest = std::max(widest, angle_between(centre, directions_[v]));
    return widest;
  }

  /// Whether a patch's triangle runs counter-clockwise and lies within `reach` of the ball.
  [[nodiscard]] bool is_ear(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Eigen::Vector3d& p = directions_[a];
    const Eigen::Vector3d& q = directions_[b];
    const Eigen::Vector3d& r = directions_[c];
    const Eigen::Vector3d normal = (q - p).cross(r - p);
    if (normal.dot(p) <= 0.0) return false;
    constexpr double slack = 0.98;
    if ((p - q).dot(r - q) <= 0.0) return angle_between(p, r) <= 2.0 * slack * reach;
    return angle_between(normal.normalized(), p) <= slack * reach;
  }

  /// Cuts off the ear with the shortest new side, again and again.
  void cut_ears(Chain& loop) {
    constexpr std::size_t many = 256;  // quadratic time ends here
    while (loop.size() > 2 && loop.size() < many) {
      const std::size_t n = loop.size();
      std::size_t best = n;
      double shortest = arc_step;  // rings expect no longer sides
      for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t a = loop[(i + n - 1) % n];
        const std::uint32_t c = loop[(i + 1) % n];
        const double side = angle_between(directions_[a], directions_[c]);
        if (side >= shortest || !is_ear(a, loop[i], c)) continue;
        shortest = side;
        best = i;
      }
      if (best == n) return;
      add(loop[(best + n - 1) % n], loop[best], loop[(best + 1) % n]);
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
      drop_returns(loop);
    }
  }

  /// A ring of faces along the loop; the loop moves to its inner side.
  void add_ring(std::uint32_t origin, const Eigen::Vector3d& centre, Chain& loop) {
    const std::size_t n = loop.size();
    std::uint32_t middle = none;  // where the ring reaches the centre
    Chain inner;
    for (const std::uint32_t v : loop) {
      const double angle = angle_between(centre, directions_[v]);
      if (angle > ring_step) {
        inner.push_back(add_vertex(origin, along(directions_[v], centre, ring_step / angle)));
      } else {
        if (middle == none) middle = add_vertex(origin, centre);
        inner.push_back(middle);
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const Eigen::Vector3d& p = directions_[inner[i]];
      const Eigen::Vector3d& q = directions_[loop[i]];
      if ((p - directions_[loop[j]]).norm() < (q - directions_[inner[j]]).norm()) {
        add(inner[i], loop[i], loop[j]);
        add(inner[i], loop[j], inner[j]);
      } else {
        add(inner[i], loop[i], inner[j]);
        add(loop[i], loop[j], inner[j]);
      }
    }
    loop = inner;
    drop_returns(loop);
  }

  /// A direction whose opposite cannot be one in which the vertex is the farthest of its fan, so
  /// that great circles from it to the loop cover all directions in which it is. Such directions u
  /// have u * N > 0 for N = sum of normals weighted by angle (Baerentzen and Aanaes 2005), and
  /// u * S <= 0 for S = sum of directions into the faces; N vanishes where both sides of a sheet
  /// meet, S on flat fans.
  [[nodiscard]] Eigen::Vector3d patch_centre(const Chain& fan) const {
    Eigen::Vector3d normals = Eigen::Vector3d::Zero();
    Eigen::Vector3d inwards = Eigen::Vector3d::Zero();
    double angles = 0.0;
    for (const std::uint32_t h : fan) {
      const Eigen::Vector3d p = mesh_.vertices[sides_.start[h]].cast<double>();
      const auto edge_to = [&](std::uint32_t v) -> Eigen::Vector3d {
        return (mesh_.vertices[v].cast<double>() - p).stableNormalized();
      };
      const Eigen::Vector3d a = edge_to(sides_.start[MeshSides::next(h)]);
      const Eigen::Vector3d b = edge_to(sides_.start[MeshSides::previous(h)]);
      const double angle = angle_between(a, b);
      angles += angle;
      normals += angle * normal(h);
      inwards += angle * (a + b).stableNormalized();
    }
    constexpr double significant = 0.05;
    if (normals.norm() > significant * angles) return normals.normalized();
    if (inwards.norm() > significant * angles) return -inwards.normalized();
    return normal(fan.front());
  }

  /// The strip between the side of h and that of its twin.
  void add_strip(std::uint32_t h) {
    const Chain& start = arcs_[h];             // from the twin's side to this one
    const Chain& end = arcs_[sides_.twin[h]];  // from this side to the twin's
    const std::size_t m = start.size() - 1;
    const std::size_t n = end.size() - 1;
    for (std::size_t i = 0, j = 0; i < m || j < n;) {
      if (j == n || (i < m && (2 * i + 1) * n <= (2 * j + 1) * m)) {
        add(end[j], start[m - i], start[m - i - 1]);
        ++i;
      } else {
        add(end[j], start[m - i], end[j + 1]);
        ++j;
      }
    }
  }

  const TriangleMesh& mesh_;
  double margin_;
  MeshSides sides_;
  offset::Burial burial_;
  std::vector<std::uint32_t> moved_;         // per half-edge: the new vertex of its start
  std::vector<Chain> arcs_;                  // per half-edge: at its start, from its twin's side
  std::vector<Eigen::Vector3d> directions_;  // per new vertex: the unit vector of its move
  TriangleMesh result_;
};

}  // namespace

TriangleMesh offset_surface(const TriangleMesh& mesh, double margin) {
  if (!std::isfinite(margin))
    throw InputError("a margin is " + std::to_string(margin) + "; it must be finite (metres)");
  if (margin == 0.0) return mesh;
  const TriangleMesh welded = weld(mesh);
  if (margin < 0.0) return offset::erode_surface(welded, -margin);
  TriangleMesh grown = weld(Grower(welded, margin).run());
  offset::cancel_opposites(grown);
  offset::separate_edges(grown);
  return grown;
}

}  // namespace penumbra
