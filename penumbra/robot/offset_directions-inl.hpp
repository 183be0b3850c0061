// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace penumbra::offset {

inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 2.0 * std::atan2((a - b).norm(), (a + b).norm());
}

/// The unit vector a share `t` of the way along the great circle; a and b not opposite.
inline Eigen::Vector3d along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double t) {
  const double angle = angle_between(a, b);
  if (angle < 1e-9) return a;
  return (std::sin((1.0 - t) * angle) * a + std::sin(t * angle) * b).normalized();
}

/// The smallest cap that was found around directions that were added one by one.
struct Cap {
  Eigen::Vector3d centre;
  double radius = 0.0;

  /// False, and unchanged, where the cap would grow beyond `limit`.
  bool add(const Eigen::Vector3d& u, double limit) {
    const double distance = angle_between(centre, u);
    if (distance <= radius) return true;
    const double grown = (radius + distance) / 2.0;
    if (grown > limit) return false;
    centre = along(centre, u, (grown - radius) / distance);
    radius = grown;
    return true;
  }
};

}  // namespace penumbra::offset
