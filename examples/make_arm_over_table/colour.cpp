// SPDX-License-Identifier: Apache-2.0
#include "parallel.hpp"
#include "sensor.hpp"

#include <cmath>

namespace example {
namespace {

const Vector3d light(0.35, -0.75, 1.25);  // metres per metre of height: far away
constexpr double light_distance = 6.0;

/// How the finish changes a colour at a point of the shape's frame.
double finish_factor(const Thing& thing, const Vector3d& p) {
  switch (thing.finish) {
    case Finish::wood: {
      const double board = std::floor(p.y() / 0.13);
      const double seam = std::abs(p.y() / 0.13 - board - 0.5) > 0.488 ? 0.80 : 1.0;
      return seam * (1.0 + 0.035 * std::sin(12.9 * board)) *
             (1.0 + 0.025 * std::sin(70.0 * p.y() + 2.5 * std::sin(4.0 * p.x() + board)));
    }
    case Finish::tiles: {
      const auto off = [](double x) { return std::abs(x / 0.5 - std::round(x / 0.5)); };
      return off(p.x()) < 0.012 || off(p.y()) < 0.012 ? 0.85 : 1.0;
    }
    default:
      return 1.0;
  }
}

Vector3d colour_of(const Scene& scene, const Ray& ray) {
  const Seen seen = scene.nearest(ray);
  if (seen.thing == nullptr) return Vector3d::Zero();
  const Vector3d point = ray.origin + seen.t * ray.direction;
  const Vector3d to_light = light.normalized();
  const double facing = std::max(0.0, seen.normal.dot(to_light));
  const bool lit = facing > 0.0 && !scene.blocked(point, light_distance * to_light);
  const double sky = 0.48 + 0.10 * seen.normal.z();
  const double diffuse = sky + (lit ? 0.55 * facing : 0.0);
  Vector3d colour =
      finish_factor(*seen.thing, seen.thing->inverse * point) * diffuse * seen.thing->colour;
  if (seen.thing->finish == Finish::gloss && lit) {
    const Vector3d half = (to_light - ray.direction.normalized()).normalized();
    colour += Vector3d::Constant(0.35 * std::pow(std::max(0.0, seen.normal.dot(half)), 40.0));
  }
  return colour;
}

}  // namespace

std::vector<std::uint8_t> shade_colours(const Scene& scene, const View& view) {
  constexpr auto row_bytes = static_cast<std::size_t>(View::width) * 3;
  std::vector<std::uint8_t> rgb(row_bytes * View::height);
  for_each_row(View::height, [&](int v) {
    std::uint8_t* out = rgb.data() + static_cast<std::size_t>(v) * row_bytes;
    for (int u = 0; u < View::width; ++u) {
      Vector3d sum = Vector3d::Zero();
      for (const double du : {-0.25, 0.25})
        for (const double dv : {-0.25, 0.25}) sum += colour_of(scene, view.ray(u + du, v + dv));
      for (int c = 0; c < 3; ++c)
        *out++ = static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, sum[c] / 4.0)));
    }
  });
  return rgb;
}

}  // namespace example
