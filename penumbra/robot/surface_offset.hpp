// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <penumbra/base/triangle_mesh.hpp>

namespace penumbra {

/// An offset surface lies inside the exact one by at most this share of the margin.
inline constexpr double offset_error = 0.02;

/// A shrunk surface comes nearer to the old one than the margin by at most this share of the
/// margin,
inline constexpr double shrink_error_outwards = 0.25;
/// and stays farther from it by at most this share.
inline constexpr double shrink_error_inwards = 0.5;

/// The mesh grown by `margin` metres on all sides: the surface of its sum with a ball. Convex edges
/// and corners come out round. The result never lies outside of the exact surface (but for float
/// rounding) and nowhere more than offset_error * margin inside it, seen from outside: what
/// crosses itself in concave places lies inside and is left there, so that signed volumes of the
/// result mean little. Closed pieces stay closed and come out wound outwards, however they were
/// wound; open ones grow on both sides into closed shells.
///
/// A negative margin shrinks closed pieces: the result is closed, wound outwards and lies inside
/// the mesh. Where all details survive, every plane moves inwards, edges stay sharp and the
/// distance keeps within 5 %. Else (a rounding of a smaller radius, a groove, a thin wall) the
/// surface is found on a grid of cells of 0.9 of the margin or less: a new mesh, of about 3.7
/// triangles per square of the margin's length on the surface but at most a million or so, whose
/// points keep to the bounds below; parts whose depth nowhere exceeds the inner one may be missing.
/// Surfaces inside another piece of the mesh count as walls: material shrinks from them, too.
///
/// Throws InputError for a margin that is not finite, and for a negative one of an open mesh, one
/// that leaves nothing of the mesh, and one for which the grid would be too fine. Zero returns the
/// mesh.
[[nodiscard]] TriangleMesh offset_surface(const TriangleMesh& mesh, double margin);

}  // namespace penumbra
