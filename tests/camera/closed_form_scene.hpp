// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/mesh/triangle_mesh.hpp>

namespace penumbra::test {

/// A box or a sphere in the optical frame, metres.
struct Solid {
  Eigen::Isometry3d T_camera_solid = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  ///< of a box
  double radius = 0;                                       ///< of a sphere, if not 0

  /// Depth at which the ray (x, y, 1) from the origin enters; 0 where it misses.
  [[nodiscard]] double depth(const Eigen::Vector2d& ray) const;

  [[nodiscard]] double reach() const;     ///< of its points from its centre
  [[nodiscard]] double farthest() const;  ///< depth that no point of it exceeds

  /// Its surface. A sphere's triangles lie no more than `sphere_error` inside of it.
  [[nodiscard]] TriangleMesh mesh() const;
  static constexpr double sphere_error = 1e-4;  ///< metres, for radii up to 0.2 m
};

struct Hit {
  double depth = 0;       ///< metres; 0: nothing
  std::size_t index = 0;  ///< of the solid + 1; 0: nothing
};

/// What the ray (x, y, 1) from the origin meets first.
Hit nearest_hit(const std::vector<Solid>& solids, const Eigen::Vector2d& ray);

/// Boxes and spheres of 2 to 40 cm, 0.4 to 1.5 m from the camera, up to `angle` radians off its
/// axis, and wholly before it.
std::vector<Solid> random_solids(std::size_t count, double angle, std::mt19937_64& random);

}  // namespace penumbra::test
