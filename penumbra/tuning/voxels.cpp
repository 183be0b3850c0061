// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>

#include <penumbra/tuning/voxels-inl.hpp>

namespace penumbra::tuning {
namespace {

using Numbers = Eigen::Vector3i;

constexpr int bits = 21;
constexpr int middle = 1 << (bits - 1);

Voxel voxel_of(const Numbers& numbers) {
  Voxel voxel = 0;
  for (int i = 0; i < 3; ++i) voxel = (voxel << bits) | static_cast<Voxel>(numbers[i] + middle);
  return voxel;
}

Numbers numbers_of(Voxel voxel) {
  Numbers numbers;
  for (int i = 2; i >= 0; --i, voxel >>= bits)
    numbers[i] = static_cast<int>(voxel & ((Voxel{1} << bits) - 1)) - middle;
  return numbers;
}

/// Calls f for every voxel within `reach` in each direction, including the voxel itself.
template <typename F>
void for_each_near(Voxel voxel, int reach, F&& f) {
  const Numbers numbers = numbers_of(voxel);
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) f(voxel_of(numbers + Numbers(x, y, z)));
}

/// Returns the certain voxels connected with `first`; removes them from `left`.
std::vector<Voxel> take_piece(Voxel first, VoxelSet& left) {
  std::vector<Voxel> piece{first};
  left.erase(first);
  for (std::size_t i = 0; i < piece.size(); ++i)
    for_each_near(piece[i], 1, [&](Voxel next) {
      const auto found = left.find(next);
      if (found == left.end() || !found->second) return;
      piece.push_back(next);
      left.erase(found);
    });
  return piece;
}

/// Returns the corners of a voxel's face, counter-clockwise seen from outside.
std::array<Numbers, 4> face_of(const Numbers& voxel, int axis, int side) {
  Numbers u = Numbers::Zero(), v = Numbers::Zero(), corner = voxel;
  u[(axis + 1) % 3] = 1;
  v[(axis + 2) % 3] = 1;
  corner[axis] += side;
  if (side == 0) std::swap(u, v);
  return {corner, corner + u, corner + u + v, corner + v};
}

}  // namespace

Voxel voxel_at(const Eigen::Vector3d& point) {
  return voxel_of((point / voxel_size).array().floor().cast<int>().matrix());
}

Eigen::Vector3d centre_of(Voxel voxel) {
  return (numbers_of(voxel).cast<double>() + Eigen::Vector3d::Constant(0.5)) * voxel_size;
}

std::vector<VoxelSet> pieces_of(const VoxelSet& voxels, std::size_t least, int reach) {
  std::vector<VoxelSet> pieces;
  VoxelSet left = voxels;
  for (const auto& [voxel, certain] : voxels) {
    if (!certain || !left.contains(voxel)) continue;
    const std::vector<Voxel> piece = take_piece(voxel, left);
    if (piece.size() < least) continue;
    VoxelSet& grown = pieces.emplace_back();
    for (const Voxel part : piece)
      for_each_near(part, reach, [&](Voxel near) {
        if (const auto found = voxels.find(near); found != voxels.end()) grown.insert(*found);
      });
  }
  return pieces;
}

void add_boundary(const VoxelSet& voxels, TriangleMesh& mesh) {
  std::unordered_map<Voxel, std::uint32_t> vertices;
  const auto vertex = [&](const Numbers& corner) {
    const auto [at, is_new] =
        vertices.emplace(voxel_of(corner), static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back((corner.cast<double>() * voxel_size).cast<float>());
    return at->second;
  };
  for (const auto& [voxel, certain] : voxels) {
    const Numbers numbers = numbers_of(voxel);
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        Numbers next = numbers;
        next[axis] += side == 0 ? -1 : 1;
        if (voxels.contains(voxel_of(next))) continue;
        std::array<std::uint32_t, 4> corners{};
        const auto face = face_of(numbers, axis, side);
        for (std::size_t i = 0; i < 4; ++i) corners[i] = vertex(face[i]);
        mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        mesh.triangles.push_back({corners[0], corners[2], corners[3]});
      }
    }
  }
}

}  // namespace penumbra::tuning
