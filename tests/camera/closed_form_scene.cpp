// SPDX-License-Identifier: Apache-2.0
#include "closed_form_scene.hpp"

#include "../support/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace penumbra::test {
namespace {

constexpr double nearest_depth = 0.02;  // metres: behind the renderer's near plane

double sphere_depth(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& ray) {
  const double a = ray.squaredNorm();
  const double b = ray.dot(centre);
  const double root = b * b - a * (centre.squaredNorm() - radius * radius);
  if (root < 0) return 0;
  return std::max((b - std::sqrt(root)) / a, 0.0);
}

double box_depth(const Solid& box, const Eigen::Vector3d& ray) {
  const Eigen::Isometry3d to_box = box.T_camera_solid.inverse();
  const Eigen::Vector3d from = to_box.translation();
  const Eigen::Vector3d along = to_box.linear() * ray;
  double enter = 0;
  double leave = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double a = (-box.half_extents[i] - from[i]) / along[i];
    const double b = (box.half_extents[i] - from[i]) / along[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave ? enter : 0;
}

}  // namespace

double Solid::depth(const Eigen::Vector2d& ray) const {
  const Eigen::Vector3d direction(ray.x(), ray.y(), 1);
  return radius > 0 ? sphere_depth(T_camera_solid.translation(), radius, direction)
                    : box_depth(*this, direction);
}

double Solid::reach() const { return std::max(radius, half_extents.norm()); }

double Solid::farthest() const { return T_camera_solid.translation().z() + reach(); }

TriangleMesh Solid::mesh() const {
  constexpr int rings = 96;  // for sphere_error
  return radius > 0 ? sphere(static_cast<float>(radius), rings) : box(half_extents.cast<float>());
}

Hit nearest_hit(const std::vector<Solid>& solids, const Eigen::Vector2d& ray) {
  Hit nearest;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const double depth = solids[i].depth(ray);
    if (depth > 0 && (nearest.index == 0 || depth < nearest.depth)) nearest = {depth, i + 1};
  }
  return nearest;
}

std::vector<Solid> random_solids(std::size_t count, double angle, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Solid> solids;
  while (solids.size() < count) {
    const double distance = 0.4 + 1.1 * unit(random);
    const double off = angle * std::sqrt(unit(random));
    const double round = 2 * std::numbers::pi * unit(random);
    Solid solid;
    solid.T_camera_solid.translation() =
        distance * Eigen::Vector3d(std::sin(off) * std::cos(round), std::sin(off) * std::sin(round),
                                   std::cos(off));
    solid.T_camera_solid.linear() =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized()
            .toRotationMatrix();
    if (random() % 2 == 0)
      solid.radius = 0.02 + 0.18 * unit(random);
    else
      solid.half_extents = Eigen::Vector3d(0.01 + 0.19 * unit(random), 0.01 + 0.19 * unit(random),
                                           0.01 + 0.19 * unit(random));
    if (solid.reach() < solid.T_camera_solid.translation().z() - nearest_depth)
      solids.push_back(solid);
  }
  return solids;
}

}  // namespace penumbra::test
