// SPDX-License-Identifier: Apache-2.0
// Scenes whose images have a formula.
#include "render_test.hpp"
#include "shapes.hpp"

namespace penumbra::test {
namespace {

PENUMBRA_RENDER_TEST(ClosedForm, 2);

/// Expects every pixel's depth to be expected(ray), which is 0 where nothing is.
template <typename Depth>
void expect_depth(const Frame& frame, const Intrinsics& intrinsics, Depth&& expected) {
  double worst = 0.0;
  for (const auto [u, v] : each_pixel(intrinsics)) {
    const double z = expected(intrinsics.ray(u, v)), error = std::abs(frame.depth(u, v) - z);
    worst = std::max(worst, z > 0.0 ? error / z : error);
  }
  EXPECT_LE(worst, interior_tolerance);
}

TEST_P(ClosedForm, TiltedPlanes) {
  for (const double degrees : {-80.0, -45.0, -5.0, 20.0, 60.0, 75.0})
    for (const Vector3d& axis : {Vector3d::UnitX().eval(), Vector3d::UnitY().eval()}) {
      const AngleAxisd tilt(degrees * M_PI / 180.0, axis);
      Scene scene;
      scene.add(quad({-40, -40, 0}, {-40, 40, 0}, {40, 40, 0}, {40, -40, 0}),
                Translation3d(0, 0, 2) * tilt);
      const Vector3d normal = tilt * Vector3d::UnitZ();
      const Frame frame = render(small_camera, scene);
      expect_depth(frame, small_camera, [&](const Vector3d& ray) {
        const double z = normal.z() * 2.0 / normal.dot(ray);
        const Vector3d on_plane = tilt.inverse() * (ray * z - Vector3d(0, 0, 2));
        return z > 0 && on_plane.cwiseAbs().maxCoeff() <= 40 ? z : 0.0;
      });
    }
}

TEST_P(ClosedForm, SphereFollowsItsFormula) {
  constexpr double radius = 0.5;
  constexpr int rings = 100;
  // How far the triangles, with corners on the sphere, lie inside of it: half a facet's diagonal
  // spans an angle of pi / (rings sqrt 2).
  const double sagitta = radius * (1.0 - std::cos(M_PI / (rings * std::sqrt(2.0))));
  const Vector3d centre(0.1, -0.07, 2.0);
  Scene scene;
  scene.add(sphere(radius, rings),
            Translation3d(centre) * AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  const Frame frame = render(small_camera, scene);
  for (const auto [u, v] : each_pixel(small_camera)) {
    const Vector3d ray = small_camera.ray(u, v);
    const double a = ray.squaredNorm(), b = ray.dot(centre);
    const double root = b * b - a * (centre.squaredNorm() - radius * radius);
    if (root < -0.01) {
      EXPECT_EQ(frame.depth(u, v), 0.0F) << u << ' ' << v;
    }
    if (root < 0.05) continue;  // too close to the silhouette for the formula
    const double z = (b - std::sqrt(root)) / a;
    const double steepness = (centre - ray * z).dot(ray) / radius;
    EXPECT_GE(frame.depth(u, v), z * (1 - interior_tolerance)) << u << ' ' << v;
    EXPECT_LE(frame.depth(u, v), (z + sagitta / steepness) * (1 + interior_tolerance))
        << u << ' ' << v;
  }
}

}  // namespace
}  // namespace penumbra::test
