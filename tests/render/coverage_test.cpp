// SPDX-License-Identifier: Apache-2.0
// Which pixels are covered: the pixel-centre convention, shared edges, image sizes; and formulas.
#include "render_test.hpp"
#include "shapes.hpp"

namespace penumbra::test {
namespace {

PENUMBRA_RENDER_TEST(Coverage, 2);

/// Powers of two, and depth 1: image points on a grid of 1/256 pixel have exact coordinates.
const Intrinsics exact_camera(128, 96, 512.0, 512.0, 64.0, 48.0);

std::size_t covered_inside(const Frame& frame, int u0, int v0, int u1, int v1) {
  std::size_t count = 0;
  for (int v = v0; v <= v1; ++v)
    for (int u = u0; u <= u1; ++u) count += frame.depth(u, v) > 0 ? 1 : 0;
  return count;
}

TEST_P(Coverage, PixelCentresAreAtIntegers) {
  // Edges half-way between centres, moved by just less than half a pixel and by just more.
  for (const auto& [shift, first] : {std::pair(0.0, 0), {0.49, 0}, {-0.49, 0}, {0.51, 1}}) {
    Scene scene;
    scene.add(
        image_rectangle(exact_camera, 9.5 + shift, 4.5 + shift, 19.5 + shift, 14.5 + shift, 1.0));
    const Frame frame = render(exact_camera, scene);
    EXPECT_EQ(frame.covered(), 100U) << shift;
    EXPECT_EQ(covered_inside(frame, 10 + first, 5 + first, 19 + first, 14 + first), 100U) << shift;
  }
}

/// A grid over a rectangle in the image whose inner corners are moved about: onto pixel centres, by
/// steps of the sub-pixel grid, or anyhow.
TriangleMesh jittered_grid(std::mt19937_64& random, const Vector2d& low, const Vector2d& high,
                           int cells, double depth_wave) {
  std::uniform_real_distribution<double> jitter(-0.3, 0.3);
  const Vector2d step = (high - low) / cells;
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      Vector2d p = low + step.cwiseProduct(Vector2d(i, j));
      if (i > 0 && i < cells) p.x() += jitter(random) * step.x();
      if (j > 0 && j < cells) p.y() += jitter(random) * step.y();
      const auto kind = random() % 4;
      if (kind < 2 && step.minCoeff() > 3) {
        const Vector2d snapped(std::round(p.x()), kind == 0 ? std::round(p.y()) : p.y());
        if (i > 0 && i < cells) p.x() = snapped.x();
        if (j > 0 && j < cells) p.y() = snapped.y();
      }
      const double z = 1.0 + depth_wave * std::sin(0.1 * p.x() + 0.07 * p.y());
      mesh.vertices.emplace_back((exact_camera.ray(p.x(), p.y()) * z).cast<float>());
    }
  const auto index = [&](int i, int j) { return std::uint32_t(j * (cells + 1) + i); };
  for (const auto [i, j] : each_pixel(0, 0, cells, cells)) {
    // Either diagonal, either winding.
    std::array cell{index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)};
    std::rotate(cell.begin(), cell.begin() + std::ptrdiff_t(random() % 4), cell.end());
    const std::uint32_t a = cell[0], b = cell[1], c = cell[2], d = cell[3];
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back(random() % 2 == 0 ? std::array{b, c, d} : std::array{b, d, c});
  }
  return mesh;
}

TEST_P(Coverage, GridsHaveNoCracks) {
  std::mt19937_64 random = seeded_random(41);
  for (const double depth_wave : {0.0, 0.05})
    for (const int cells : {1, 2, 3, 7, 16, 40, 150}) {
      Scene scene;
      scene.add(jittered_grid(random, {9.5, 4.5}, {109.5, 84.5}, cells, depth_wave));
      const Frame frame = render(exact_camera, scene);
      EXPECT_EQ(covered_inside(frame, 10, 5, 109, 84), 8000U) << cells << " cells";
      if (depth_wave == 0.0) {
        EXPECT_EQ(frame.covered(), 8000U) << cells << " cells";
      }
    }
}

TEST_P(Coverage, EveryImageSize) {
  std::mt19937_64 random = seeded_random(44);
  constexpr int sizes[][2] = {{1, 1},   {1, 50},  {2, 3},  {3, 2},  {5, 7},   {15, 16},
                              {17, 15}, {33, 17}, {63, 9}, {65, 8}, {4095, 3}};
  for (const auto& [width, height] : sizes) {
    const Intrinsics camera(width, height, 0.8 * width, 0.9 * width, 0.4 * width, 0.6 * height);
    for (int round = 0; round < 3; ++round) {
      Scene scene;
      scene.add(box({0.2F, 0.3F, 0.15F}), random_pose(random, {-0.4, -0.4, 0.8}, {0.4, 0.4, 1.5}));
      scene.add(triangle_soup(random, 5, 2.0F), at(0, 0, 2.5));
      expect_agrees_with_brute_force(render(camera, scene).view(), scene, camera);
    }
  }
}

// Scenes whose images have a formula.

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
