// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/camera/camera.hpp>
#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra::test {

/// Meshes for tests. Closed ones are wound outwards.

[[nodiscard]] TriangleMesh triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                    const Eigen::Vector3f& c);

/// Two triangles over four corners in order.
[[nodiscard]] TriangleMesh quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                const Eigen::Vector3f& c, const Eigen::Vector3f& d);

/// A rectangle that faces the camera at depth z and whose image is [u0, u1] x [v0, v1].
[[nodiscard]] TriangleMesh image_rectangle(const Intrinsics& intrinsics, double u0, double v0,
                                           double u1, double v1, double z);

/// A box about the origin.
[[nodiscard]] TriangleMesh box(const Eigen::Vector3f& half_size);

/// A sphere about the origin, its corners on the surface: `rings` from pole to pole, twice as many
/// around.
[[nodiscard]] TriangleMesh sphere(float radius, int rings);

/// A closed ring of tube about z, of rows x columns quads.
[[nodiscard]] TriangleMesh torus(std::uint32_t rows, std::uint32_t columns, double ring,
                                 double tube);

/// A surface of revolution about z, wound outwards where the profile (radius, z) runs upwards with
/// the body on its inner side. Open where the profile ends off the axis.
[[nodiscard]] TriangleMesh revolved(const std::vector<Eigen::Vector2f>& profile,
                                    std::uint32_t around);

/// Adds the triangles of another mesh.
void append(TriangleMesh& mesh, const TriangleMesh& other);

/// The mirrored mesh: x negated, corners in the same order, so wound inwards.
[[nodiscard]] TriangleMesh mirrored(TriangleMesh mesh);

/// Random triangles, corners within `extent` of the origin.
[[nodiscard]] TriangleMesh triangle_soup(std::mt19937_64& random, int count, float extent);

[[nodiscard]] Eigen::Isometry3d random_pose(std::mt19937_64& random,
                                            const Eigen::Vector3d& low_corner,
                                            const Eigen::Vector3d& high_corner);

/// The smallest rotation that turns `from` into the direction of `to`. Eigen's own adds ten
/// seconds to the compilation of each file.
[[nodiscard]] Eigen::Quaterniond turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace penumbra::test
