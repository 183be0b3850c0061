// SPDX-License-Identifier: Apache-2.0
#include "pasted_object.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace penumbra::test {
/// A plate in the camera's frame.
struct Paster::Plate {
  ObjectKind kind;
  Eigen::Matrix3d rotation;  // columns: the plate's axes and normal
  Eigen::Vector3d centre;

  [[nodiscard]] SurfaceHit hit(const Eigen::Vector3d& ray) const {
    const double depth = rotation.col(2).dot(centre) / rotation.col(2).dot(ray);
    const Eigen::Vector3d p = rotation.transpose() * (depth * ray - centre);
    const double from_centre = kind.shape == Shape::square
                                   ? std::max(std::abs(p.x()), std::abs(p.y()))
                                   : std::hypot(p.x(), p.y());
    return {depth, kind.size / 2 - from_centre};
  }

  /// Half the width of the pixel window that holds the plate and its edge.
  [[nodiscard]] int window(const Intrinsics& camera) const {
    return static_cast<int>(0.75 * kind.size * camera.fx() / (centre.z() - kind.size / 2)) + 6;
  }

  /// Calls f(u, v, hit) for the pixels that the window and the image share.
  template <typename F>
  void for_each_pixel(const Intrinsics& camera, F&& f) const {
    const Eigen::Vector2d middle = camera.project(centre);
    const int reach = window(camera);
    const int u0 = static_cast<int>(middle.x()), v0 = static_cast<int>(middle.y());
    for (int v = std::max(0, v0 - reach); v <= std::min(camera.height() - 1, v0 + reach); ++v)
      for (int u = std::max(0, u0 - reach); u <= std::min(camera.width() - 1, u0 + reach); ++u)
        f(u, v, hit(camera.ray(u, v)));
  }
};

Paster::Paster(const SensorModel& model, std::mt19937_64::result_type seed) : paste_(model, seed) {}

Paster::Plate Paster::place(const RealFrame& frame, const ObjectKind& kind, double gap) {
  std::mt19937_64& random = paste_.random();
  const int width = frame.intrinsics.width();
  const int pixel = frame.robot_indices[random() % frame.robot_indices.size()];
  const int u = pixel % width, v = pixel / width;
  const double towards = uniform(random, 0.0, 2 * std::numbers::pi);
  const double turn = uniform(random, 0.0, 2 * std::numbers::pi);
  Plate plate{kind, {}, {}};
  const Eigen::Vector3d lean(std::cos(towards), std::sin(towards), 0.0);
  plate.rotation =
      (Eigen::AngleAxisd(kind.tilt, lean) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  // Bring it nearer until all of it keeps the gap; what is under it changes a little on the way.
  double z = static_cast<double>(frame.robot(u, v)) - gap;
  for (double excess = 1.0; excess > 1e-4;) {
    plate.centre = z * frame.intrinsics.ray(u, v);
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
    plate.for_each_pixel(frame.intrinsics, [&](int x, int y, const SurfaceHit& hit) {
      if (hit.inside < 0.0) return;
      farthest = std::max(farthest, hit.depth);
      if (frame.robot(x, y) > 0.0f)
        nearest = std::min(nearest, static_cast<double>(frame.robot(x, y)));
    });
    excess = farthest - (nearest - gap);
    z -= std::max(0.0, excess);
  }
  return plate;
}

void Paster::paste(RealFrame& frame, const ObjectKind& kind, double gap) {
  paste_.begin();
  const Plate plate = place(frame, kind, gap);
  plate.for_each_pixel(frame.intrinsics,
                       [&](int u, int v, const SurfaceHit& hit) { paste_.add(frame, hit, u, v); });
}

}  // namespace penumbra::test
