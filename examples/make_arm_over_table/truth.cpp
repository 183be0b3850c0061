// SPDX-License-Identifier: Apache-2.0
#include "parallel.hpp"
#include "sensor.hpp"

namespace example {
namespace {

constexpr auto pixels = static_cast<std::size_t>(View::width) * View::height;

MaskValue mask_value(const Scene& scene, const Ray& ray, const Seen& seen) {
  if (scene.nearest(ray, Kind::robot).thing == nullptr) return no_robot;
  if (seen.thing->kind != Kind::robot) return before_robot;
  return scene.nearest(ray, Kind::object).thing != nullptr ? hidden : robot_seen;
}

}  // namespace

Truth cast_truth(const Scene& scene, const View& view) {
  Truth truth{std::vector<double>(pixels, std::numeric_limits<double>::infinity()),
              std::vector<double>(pixels), std::vector<std::uint8_t>(pixels),
              std::vector<std::uint8_t>(pixels)};
  const Vector3d second = view.T_base_camera * Vector3d(View::baseline, 0.0, 0.0);
  for_each_row(View::height, [&](int v) {
    for (int u = 0; u < View::width; ++u) {
      const Ray ray = view.ray(u, v);
      const Seen seen = scene.nearest(ray);
      if (seen.thing == nullptr) continue;
      const std::size_t i = static_cast<std::size_t>(v) * View::width + static_cast<std::size_t>(u);
      const Vector3d point = ray.origin + seen.t * ray.direction;
      truth.depth[i] = seen.t;
      truth.facing[i] = -seen.normal.dot(ray.direction.normalized());
      truth.shade[i] = scene.blocked(point, second - point) ? 1 : 0;
      truth.mask[i] = mask_value(scene, ray, seen);
    }
  });
  return truth;
}

}  // namespace example
