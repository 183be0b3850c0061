// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra {

/// How far the faces of a round primitive may lie from its true surface, metres: corners this much
/// outside, the middles of faces this much inside. A silhouette errs by no more.
inline constexpr double primitive_error = 9e-5;

/// Primitives, centred, axis z, metres; closed and wound outwards. Sizes must be finite and
/// positive (a capsule's length, that of its cylindrical part, may be 0). Throws InputError for
/// others, and for a radius so large (spheres and capsules 100 m, cylinders 10 km) that
/// primitive_error would take millions of triangles.
[[nodiscard]] TriangleMesh make_box(const Eigen::Vector3d& size);
[[nodiscard]] TriangleMesh make_cylinder(double radius, double length);
[[nodiscard]] TriangleMesh make_sphere(double radius);
[[nodiscard]] TriangleMesh make_capsule(double radius, double length);

}  // namespace penumbra
