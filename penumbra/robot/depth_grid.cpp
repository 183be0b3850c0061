// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <penumbra/robot/depth_grid-inl.hpp>

namespace penumbra::offset {
namespace {

using Eigen::Vector3d;
using Index = DepthGrid::Index;

constexpr int block_side = 2;                                    // cells
const double half_diagonal = block_side * std::sqrt(3.0) / 2.0;  // cells; also a cell's diagonal

Index corner_offset(int k) { return {k & 1, k >> 1 & 1, k >> 2}; }

/// How often the solid surrounds p: its solid angles over 4 pi (van Oosterom and Strackee 1983).
double winding_number(const TriangleMesh& solid, const Vector3d& p) {
  double sum = 0.0;
  for (const auto& t : solid.triangles) {
    const Vector3d a = solid.vertices[t[0]].cast<double>() - p;
    const Vector3d b = solid.vertices[t[1]].cast<double>() - p;
    const Vector3d c = solid.vertices[t[2]].cast<double>() - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

/// Sets that hang together, by number.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[find(i)] = find(j); }

 private:
  std::vector<std::size_t> parent_;
};

/// Of points that all lie farther from the surface than half of `step`, which are inside: one point
/// of each set of neighbours is asked.
std::vector<bool> which_inside(const TriangleMesh& solid, const std::vector<Index>& points,
                               int step, const auto& position) {
  std::unordered_map<std::uint64_t, std::size_t> number;
  for (std::size_t i = 0; i < points.size(); ++i) number.emplace(DepthGrid::key(points[i]), i);
  Groups groups(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto next = number.find(DepthGrid::key(points[i] + step * Index::Unit(axis)));
      if (next != number.end()) groups.join(i, next->second);
    }
  }
  std::unordered_map<std::size_t, bool> known;
  std::vector<bool> inside(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [group, is_new] = known.try_emplace(groups.find(i), false);
    if (is_new) group->second = winding_number(solid, position(points[i])) > 0.5;
    inside[i] = group->second;
  }
  return inside;
}

}  // namespace

std::uint64_t DepthGrid::key(const Index& i) {
  const auto part = [&i](int axis) { return static_cast<std::uint64_t>(i[axis] + 1) & 0x1FFFFF; };
  return part(0) << 42 | part(1) << 21 | part(2);
}

DepthGrid::DepthGrid(const TriangleMesh& solid, const TriangleTree& tree, double depth, double cell,
                     std::size_t most_cells)
    : solid_(solid), tree_(tree), depth_(depth), cell_(cell), most_blocks_(most_cells / 8) {
  Eigen::AlignedBox3d box;
  for (const auto& v : solid.vertices) box.extend(v.cast<double>());
  constexpr double odd_share = 0.381;  // faces at round coordinates run between the corners
  origin_ = box.min() - Vector3d::Constant(odd_share * cell);
  constexpr int most_side = 1 << 20;  // for key()
  int side = block_side;
  while (side < most_side && side * cell < box.sizes().maxCoeff() + cell) side *= 2;
  fits_ = side < most_side;
  collect_blocks(Index::Zero(), side, box.diagonal().norm() + side * cell);
  if (!fits_) return;
  drop_outer_blocks();
  corners_.reserve(12 * blocks_.size());
  for (const Block& block : blocks_) sample(block);
  drop_outer_corners();
}

/// The smallest blocks through which the surface may run; `reach`: no distance is larger.
void DepthGrid::collect_blocks(const Index& lower, int side, double reach) {
  const Vector3d centre = position(lower) + Vector3d::Constant(side * cell_ / 2.0);
  const double distance = (tree_.nearest(centre, reach) - centre).norm();
  const double radius = side * cell_ * std::sqrt(3.0) / 2.0;
  if (std::abs(distance - depth_) > radius || !fits_) return;
  if (side == block_side) {
    blocks_.push_back({lower, distance});
    fits_ = blocks_.size() <= most_blocks_;
    return;
  }
  const int half = side / 2;
  for (int i = 0; i < 8; ++i)
    collect_blocks(lower + half * corner_offset(i), half, distance + radius);
}

/// Blocks through which no surface runs are inside or outside as a whole.
void DepthGrid::drop_outer_blocks() {
  std::vector<Block> clear;
  std::vector<Block> kept;
  for (const Block& block : blocks_)
    (block.distance > half_diagonal * cell_ ? clear : kept).push_back(block);
  std::vector<Index> lower;
  lower.reserve(clear.size());
  for (const Block& block : clear) lower.push_back(block.lower);
  const auto inside = which_inside(solid_, lower, block_side, [this](const Index& i) -> Vector3d {
    return position(i) + Vector3d::Constant(block_side * cell_ / 2.0);
  });
  for (std::size_t i = 0; i < clear.size(); ++i)
    if (inside[i]) kept.push_back(clear[i]);
  blocks_ = std::move(kept);
}

/// Samples the corners of a block's cells, but for those that one corner shows to be off.
void DepthGrid::sample(const Block& block) {
  const double reach = block.distance + 1.001 * half_diagonal * cell_;
  for (int c = 0; c < 8; ++c) {
    const Index lower = block.lower + corner_offset(c);
    bool off = false;
    for (int k = 0; k < 8 && !off; ++k) {
      const Index i = lower + corner_offset(k);
      const auto [entry, is_new] = corners_.try_emplace(key(i));
      if (is_new) {
        const Vector3d p = position(i);
        const Vector3d q = tree_.nearest(p, reach);
        const double distance = (q - p).norm();
        entry->second = {q.cast<float>(), static_cast<float>(distance), distance >= depth_};
      }
      constexpr double cell_diagonal = 1.7321;
      off = std::abs(entry->second.distance - depth_) > cell_diagonal * cell_;
    }
    if (!off) cells_.push_back(lower);
  }
}

void DepthGrid::drop_outer_corners() {
  std::vector<Index> deep;
  for (const auto& [at, corner] : corners_) {
    constexpr std::uint64_t part = 0x1FFFFF;
    if (!corner.deep) continue;
    deep.emplace_back(static_cast<int>(at >> 42) - 1, static_cast<int>(at >> 21 & part) - 1,
                      static_cast<int>(at & part) - 1);
  }
  const auto inside = which_inside(solid_, deep, 1, [this](const Index& i) { return position(i); });
  for (std::size_t i = 0; i < deep.size(); ++i) corners_.at(key(deep[i])).deep = inside[i];
}

bool DepthGrid::misses(double most) const {
  const double radius = std::sqrt(3.0) / 2.0 * cell_;  // of a corner's surroundings
  return std::any_of(cells_.begin(), cells_.end(), [&](const Index& cell) {
    double deepest = 0.0;
    for (int k = 0; k < 8; ++k)
      deepest = std::max<double>(deepest, corner(cell + corner_offset(k)).distance);
    return deepest < depth_ && deepest + radius > most &&
           has_deeper(position(cell) + Vector3d::Constant(cell_ / 2.0), cell_, most);
  });
}

/// Whether a cube has a point of the solid deeper than `most`, but for a little.
bool DepthGrid::has_deeper(const Vector3d& centre, double side, double most) const {
  const double radius = std::sqrt(3.0) / 2.0 * side;
  const double distance = (tree_.nearest(centre, 4.0 * most) - centre).norm();
  if (distance > most) return winding_number(solid_, centre) > 0.5;
  constexpr double little = 0.02;
  if (distance + radius <= most * (1.0 + little)) return false;
  for (int k = 0; k < 8; ++k) {
    const Vector3d shift = corner_offset(k).cast<double>() - Vector3d::Constant(0.5);
    if (has_deeper(centre + side / 2.0 * shift, side / 2.0, most)) return true;
  }
  return false;
}

}  // namespace penumbra::offset
