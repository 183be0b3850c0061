// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::tuning {

/// A cube of a grid, by its three numbers in one.
using Voxel = std::uint64_t;
inline constexpr double voxel_size = 0.01;  // metres

[[nodiscard]] Voxel voxel_at(const Eigen::Vector3d& point);
[[nodiscard]] Eigen::Vector3d centre_of(Voxel voxel);

/// Voxels, and whether they are certain.
using VoxelSet = std::unordered_map<Voxel, bool>;

/// Connected pieces (of 26 neighbours) of at least `least` certain voxels, each with the voxels
/// that lie at most `reach` from one of these.
[[nodiscard]] std::vector<VoxelSet> pieces_of(const VoxelSet& voxels, std::size_t least, int reach);

/// Adds the faces between a voxel and an empty one.
void add_boundary(const VoxelSet& voxels, TriangleMesh& mesh);

}  // namespace penumbra::tuning
