// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <sim/experiments/ray_cloud.hpp>

namespace penumbra::sim {
namespace {

constexpr double ray_radius = 0.02;  // metres
constexpr int step = 2;              // pixels: every second one is looked at

void add_near_ray(const Camera& camera, const Eigen::Isometry3d& T_first_camera,
                  ImageView<const std::uint16_t> depth, const Eigen::Vector3d& ray,
                  std::vector<double>& depths) {
  const Eigen::Vector3d along = ray.normalized();
  for (int v = 0; v < depth.height; v += step)
    for (int u = 0; u < depth.width; u += step) {
      if (depth(u, v) == 0) continue;
      const Eigen::Vector3d p =
          surface_at(camera.intrinsics, T_first_camera, u, v, depth(u, v) * 1e-3);
      const double distance = (p - along * along.dot(p)).squaredNorm();
      if (distance < ray_radius * ray_radius && p.z() > 0) depths.push_back(p.z());
    }
}

}  // namespace

std::vector<double> second_depths_on_ray(const Cell& cell, const Sensed& sensed,
                                         const Eigen::Vector2d& pixel) {
  const Eigen::Isometry3d T_first_second = cell.T_base_camera.inverse() * cell.T_base_second_camera;
  const Eigen::Vector3d ray = cell.camera.intrinsics.ray(pixel.x(), pixel.y());
  std::vector<double> depths;
  add_near_ray(cell.second_camera, T_first_second, sensed.second_depth, ray, depths);
  return depths;
}

}  // namespace penumbra::sim
