// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra {

/// An offset surface lies inside the exact one by at most this share of the margin.
inline constexpr double offset_error = 0.02;

/// The mesh grown by `margin` metres on all sides: the surface of its sum with a ball. Convex edges
/// and corners come out round. The result never lies outside of the exact surface (but for float
/// rounding) and nowhere more than offset_error * margin inside it, seen from outside: what
/// crosses itself in concave places lies inside and is left there, so that signed volumes of the
/// result mean little. Closed pieces stay closed and come out wound outwards, however they were
/// wound; open ones grow on both sides into closed shells.
///
/// A negative margin moves every plane of closed pieces inwards, edges stay sharp; the result is
/// checked to lie at that distance within 5 %. Throws InputError where that cannot be: an open
/// mesh, or a body, part or detail (a rounding of a smaller radius, a groove, a thin wall) that
/// vanishes. Zero returns the mesh. A margin that is not finite throws InputError.
[[nodiscard]] TriangleMesh offset_surface(const TriangleMesh& mesh, double margin);

}  // namespace penumbra
