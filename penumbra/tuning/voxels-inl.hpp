// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra::tuning {

/// A cell of a grid: its three indices in one number.
using Voxel = std::uint64_t;
inline constexpr double voxel_size = 0.01;  // metres

[[nodiscard]] Voxel voxel_at(const Eigen::Vector3d& point);
[[nodiscard]] Eigen::Vector3d centre_of(Voxel voxel);

/// Voxels, with true for certain ones.
using VoxelSet = std::unordered_map<Voxel, bool>;

/// Returns connected pieces (26 neighbours) of at least `least` certain voxels, each with all
/// voxels within `reach` of them.
[[nodiscard]] std::vector<VoxelSet> pieces_of(const VoxelSet& voxels, std::size_t least, int reach);

/// Adds the faces between voxels and empty cells.
void add_boundary(const VoxelSet& voxels, TriangleMesh& mesh);

}  // namespace penumbra::tuning
