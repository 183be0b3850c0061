// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ray_oracle.hpp"

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include <penumbra/base/image.hpp>

namespace penumbra::test {

/// Largest depth error inside a surface, in units of the depth: 0.1 mm at 1 m. It is proportional
/// to z because both sides' errors are: the rounding of single-precision inverse depths and of an
/// oracle's single-precision rays are relative errors, and so is a unit in the last place of the
/// result.
inline constexpr double interior_tolerance = 1e-4;

/// Two surfaces closer than this (metres, at 1 m and less) are one: either body may be named.
inline constexpr double coincidence = 1e-4;

/// Pixels by which the principal point may move to explain another surface at a pixel's very
/// centre.
inline constexpr double edge_shift = 0.01;

/// Pixels from a silhouette within which coverage may differ.
inline constexpr double silhouette_shift = 1.0;

/// Largest share of the robot's pixels that may be covered or named differently.
inline constexpr double differing_limit = 5e-4;

/// Counts of how one or more rendered images agree with an oracle.
struct Agreement {
  std::size_t images = 0;
  std::size_t robot_pixels = 0;  ///< of the oracle
  /// Covered by one side only, and a silhouette is within silhouette_shift.
  std::size_t silhouette_pixels = 0;
  /// Both sides show robot, but not the same surface; the one shown is seen within edge_shift.
  std::size_t edge_pixels = 0;
  std::size_t errors = 0;       ///< explained by neither: missing, extra, wrong depth or wrong body
  double worst_interior = 0.0;  ///< largest |depth error| / depth where the same surface is shown
  double worst_shift = 0.0;     ///< pixels: how far away what a differing pixel shows is to be seen
  std::vector<std::string> first_errors;  ///< some of them in words

  /// Share of the robot's pixels that differ in coverage or surface.
  [[nodiscard]] double differing_share() const;

  Agreement& operator+=(const Agreement& other);
};

std::ostream& operator<<(std::ostream& out, const Agreement& agreement);

/// Compares every pixel of a rendered image with the oracle. Casts rays near each pixel that
/// differs.
[[nodiscard]] Agreement compare(const VirtualDepthView& rendered, const RayOracle& oracle,
                                const OracleImage& expected, const Intrinsics& intrinsics);

}  // namespace penumbra::test
