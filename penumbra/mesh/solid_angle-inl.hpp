// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace penumbra {

/// Returns the solid angle of a triangle seen from `eye`, steradians; positive if `eye` sees its
/// back, so that a closed surface with outward triangles gives 4 pi from inside (van Oosterom and
/// Strackee 1983, "The solid angle of a plane triangle").
inline double solid_angle(const std::array<Eigen::Vector3d, 3>& corners,
                          const Eigen::Vector3d& eye) {
  const Eigen::Vector3d a = corners[0] - eye;
  const Eigen::Vector3d b = corners[1] - eye;
  const Eigen::Vector3d c = corners[2] - eye;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace penumbra
