// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include <penumbra/robot/depth_surface-inl.hpp>
#include <penumbra/robot/offset_cleanup-inl.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;
using Index = DepthGrid::Index;

Index offset_of(unsigned corner) {
  return {static_cast<int>(corner & 1), static_cast<int>(corner >> 1 & 1),
          static_cast<int>(corner >> 2)};
}

constexpr std::size_t edge_count = 12;

/// The edge that leaves a cell's corner along an axis: 4 * axis + the other two bits of the corner.
unsigned edge_at(unsigned corner, unsigned axis) {
  const unsigned low = corner & ((1U << axis) - 1);
  return 4 * axis + (corner >> (axis + 1) << axis | low);
}

/// The sheets of the surface in a cell: which of them crosses each edge, and how many there are.
struct Sheets {
  static constexpr std::uint8_t none = 255;
  std::array<std::uint8_t, edge_count> of;
  std::uint8_t count = 0;

  /// `deep`: a bit per corner. Where a face has deep corners at a diagonal only, each is cut off by
  /// itself: both cells at the face see it so.
  explicit Sheets(unsigned deep) {
    of.fill(none);
    const auto is_crossed = [deep](unsigned corner, unsigned axis) {
      return (deep >> corner & 1) != (deep >> (corner | 1U << axis) & 1);
    };
    for (unsigned axis = 0; axis < 3; ++axis)
      for (unsigned corner = 0; corner < 8; ++corner)
        if ((corner >> axis & 1) == 0 && is_crossed(corner, axis))
          of[edge_at(corner, axis)] = count++;
    for (unsigned face = 0; face < 6; ++face) join_on_face(deep, face / 2, face % 2);
    close_gaps();
  }

 private:
  void join(unsigned a, unsigned b) {
    const std::uint8_t kept = of[a];
    const std::uint8_t dropped = of[b];
    std::replace(of.begin(), of.end(), dropped, kept);
  }

  void join_on_face(unsigned deep, unsigned axis, unsigned side) {
    const unsigned b = (axis + 1) % 3;
    const unsigned c = (axis + 2) % 3;
    const unsigned low = side << axis;
    std::array<unsigned, 4> crossed{};
    std::size_t n = 0;
    for (const unsigned edge :
         {edge_at(low, b), edge_at(low | 1U << c, b), edge_at(low, c), edge_at(low | 1U << b, c)})
      if (of[edge] != none) crossed[n++] = edge;
    if (n == 2) join(crossed[0], crossed[1]);
    if (n < 4) return;
    const bool straight = (deep >> low & 1) != 0;  // the lowest corner is deep, and the highest
    join(crossed[0], crossed[straight ? 2 : 3]);
    join(crossed[1], crossed[straight ? 3 : 2]);
  }

  void close_gaps() {
    std::array<std::uint8_t, edge_count> name;
    name.fill(none);
    count = 0;
    for (std::uint8_t& sheet : of) {
      if (sheet == none) continue;
      if (name[sheet] == none) name[sheet] = count++;
      sheet = name[sheet];
    }
  }
};

struct Vertex {
  Vector3d at;
  Vector3d deeper;  // unit
  double off;       // metres too deep
};

class Extractor {
 public:
  Extractor(const DepthGrid& grid, const TriangleTree& tree, double depth)
      : grid_(grid), tree_(tree), depth_(depth) {}

  TriangleMesh run() {
    for (const Index& cell : grid_.cells()) add_vertices(cell);
    for (const Index& cell : grid_.cells())
      for (unsigned axis = 0; axis < 3; ++axis) add_quad(cell, axis);
    separate_edges(result_);
    return std::move(result_);
  }

 private:
  struct Entry {
    Sheets sheets;
    std::uint32_t first;  // vertex, that of sheet 0
  };

  [[nodiscard]] bool is_deep(const Index& i) const { return grid_.corner(i).deep; }

  [[nodiscard]] Vector3d deeper_at(const Vector3d& p, const Vector3d& nearest) const {
    return (p - nearest).stableNormalized();
  }

  void add_vertices(const Index& cell) {
    unsigned deep = 0;
    for (unsigned k = 0; k < 8; ++k) deep |= (is_deep(cell + offset_of(k)) ? 1U : 0U) << k;
    if (deep == 0 || deep == 255) return;
    const Sheets sheets(deep);
    sheets_.emplace(DepthGrid::key(cell),
                    Entry{sheets, static_cast<std::uint32_t>(vertices_.size())});
    for (std::uint8_t sheet = 0; sheet < sheets.count; ++sheet) {
      vertices_.push_back(settle(cell, meeting_point(cell, sheets, sheet)));
      result_.vertices.push_back(vertices_.back().at.cast<float>());
    }
  }

  /// Where the planes meet that the ends of a sheet's edges tell of, or nearly so: what they leave
  /// open is that of the mean of the sheet's crossings.
  [[nodiscard]] Vector3d meeting_point(const Index& cell, const Sheets& sheets,
                                       std::uint8_t sheet) const {
    Vector3d mean = Vector3d::Zero();
    Eigen::Matrix3d planes = Eigen::Matrix3d::Zero();
    Vector3d moves = Vector3d::Zero();  // for a mean at the origin
    int crossings = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      for (unsigned k = 0; k < 8; ++k) {
        if ((k >> axis & 1) != 0 || sheets.of[edge_at(k, axis)] != sheet) continue;
        const std::array<Index, 2> ends{cell + offset_of(k), cell + offset_of(k | 1U << axis)};
        std::array<double, 2> excess{};
        for (std::size_t i = 0; i < 2; ++i) {
          const auto& corner = grid_.corner(ends[i]);
          const Vector3d p = grid_.position(ends[i]) - grid_.position(cell);
          const Vector3d n = deeper_at(grid_.position(ends[i]), corner.nearest.cast<double>());
          excess[i] = corner.distance - depth_;
          planes += n * n.transpose();
          moves += n * (n.dot(p) - excess[i]);
        }
        const double t = excess[0] / (excess[0] - excess[1]);
        mean += (grid_.position(ends[0]) - grid_.position(cell)) * (1.0 - t) +
                (grid_.position(ends[1]) - grid_.position(cell)) * t;
        ++crossings;
      }
    }
    mean /= crossings;
    return grid_.position(cell) + solve(planes, moves, mean);
  }

  /// The least squares solution that is nearest to `start` in directions that are hardly told.
  [[nodiscard]] static Vector3d solve(const Eigen::Matrix3d& planes, const Vector3d& moves,
                                      const Vector3d& start) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(planes);
    constexpr double told = 0.02;  // of the largest; a crease of 16 degrees
    const Vector3d rest = moves - planes * start;
    Vector3d point = start;
    for (int i = 0; i < 3; ++i) {
      const double value = solver.eigenvalues()[i];
      if (value < told * solver.eigenvalues()[2]) continue;
      const Vector3d axis = solver.eigenvectors().col(i);
      point += axis * (axis.dot(rest) / value);
    }
    return point;
  }

  /// Moves a point onto the surface without leaving its cell, or by a part of a cell where the
  /// surface cannot be found in it.
  [[nodiscard]] Vertex settle(const Index& cell, const Vector3d& start) const {
    constexpr double rim = 0.02;  // keeps vertices of neighbouring cells apart
    constexpr double beyond = -0.4;
    constexpr double near_enough = 0.02;
    Vertex vertex = descend(cell, start, rim);
    if (std::abs(vertex.off) < near_enough * depth_) return vertex;
    const Vertex other = descend(cell, start, beyond);
    return std::abs(other.off) < std::abs(vertex.off) ? other : vertex;
  }

  [[nodiscard]] Vertex descend(const Index& cell, const Vector3d& start, double rim) const {
    const Vector3d low = grid_.position(cell) + Vector3d::Constant(rim * grid_.cell());
    const Vector3d high = low + Vector3d::Constant((1.0 - 2.0 * rim) * grid_.cell());
    constexpr double near_enough = 1e-3;
    constexpr int tries = 4;
    Vertex best{start, Vector3d::Zero(), std::numeric_limits<double>::infinity()};
    Vector3d p = start;
    for (int i = 0; i < tries; ++i) {
      p = p.cwiseMax(low).cwiseMin(high);
      const Vector3d q = tree_.nearest(p, depth_ + 4.0 * grid_.cell());
      const double off = (p - q).norm() - depth_;
      if (std::abs(off) >= std::abs(best.off)) break;
      best = {p, deeper_at(p, q), off};
      if (std::abs(off) < near_enough * depth_) break;
      p -= off * best.deeper;
    }
    return best;
  }

  /// The four cells around the edge that leaves a cell's lower corner along an axis.
  void add_quad(const Index& cell, unsigned axis) {
    const bool deep = is_deep(cell);
    if (deep == is_deep(cell + offset_of(1U << axis))) return;
    const unsigned b = (axis + 1) % 3;
    const unsigned c = (axis + 2) % 3;
    std::array<std::uint32_t, 4> quad{};
    const std::array<unsigned, 4> corners{1U << b | 1U << c, 1U << c, 0, 1U << b};
    for (std::size_t i = 0; i < 4; ++i) {
      const unsigned corner = corners[deep ? i : 3 - i];
      const Entry& entry = sheets_.at(DepthGrid::key(cell - offset_of(corner)));
      quad[i] = entry.first + entry.sheets.of[edge_at(corner, axis)];
    }
    const std::size_t first = bulge(quad[0], quad[2]) <= bulge(quad[1], quad[3]) ? 0 : 1;
    const auto at = [&](std::size_t i) { return quad[(first + i) % 4]; };
    result_.triangles.push_back({at(0), at(1), at(2)});
    result_.triangles.push_back({at(0), at(2), at(3)});
  }

  /// How far the middle of a diagonal is off, as its ends tell.
  [[nodiscard]] double bulge(std::uint32_t a, std::uint32_t b) const {
    const Vector3d half = (vertices_[b].at - vertices_[a].at) / 2.0;
    return std::abs(std::min(vertices_[a].deeper.dot(half), -vertices_[b].deeper.dot(half)));
  }

  const DepthGrid& grid_;
  const TriangleTree& tree_;
  double depth_;
  std::unordered_map<std::uint64_t, Entry> sheets_;
  std::vector<Vertex> vertices_;
  TriangleMesh result_;
};

}  // namespace

TriangleMesh extract_surface(const DepthGrid& grid, const TriangleTree& tree, double depth) {
  return Extractor(grid, tree, depth).run();
}

}  // namespace penumbra::offset
