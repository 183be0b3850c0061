// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <penumbra/mesh/prepared_mesh.hpp>

namespace penumbra {

/// The largest distance between the faces of a round primitive and its exact surface, metres: its
/// corners are this far outside, the middles of its faces this far inside.
inline constexpr double primitive_error = 9e-5;

/// Closed primitives around the origin, with axis z and triangles wound outwards, metres. Throws
/// InputError unless sizes are positive (a capsule's length, that of its cylindrical part, may be
/// 0) and at most 100 m for the radius of spheres and capsules, 10 km for that of cylinders and
/// 1000 km otherwise.
[[nodiscard]] TriangleMesh make_box(const Eigen::Vector3d& size);
[[nodiscard]] TriangleMesh make_cylinder(double radius, double length);
[[nodiscard]] TriangleMesh make_sphere(double radius);
[[nodiscard]] TriangleMesh make_capsule(double radius, double length);

}  // namespace penumbra
