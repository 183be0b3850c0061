// SPDX-License-Identifier: Apache-2.0
// Which pixels are covered: the pixel-centre convention, shared edges, image sizes.
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
  // Edges half-way between centres, and moved by just less than half a pixel: the same pixels.
  for (const double shift : {0.0, 0.49, -0.49}) {
    Scene scene;
    scene.add(
        image_rectangle(exact_camera, 9.5 + shift, 4.5 + shift, 19.5 + shift, 14.5 + shift, 1.0));
    const Frame frame = render(exact_camera, scene);
    EXPECT_EQ(frame.covered(), 100U) << shift;
    EXPECT_EQ(covered_inside(frame, 10, 5, 19, 14), 100U) << shift;
  }
  Scene scene;
  scene.add(image_rectangle(exact_camera, 10.01, 5.01, 20.01, 15.01, 1.0));
  const Frame frame = render(exact_camera, scene);
  EXPECT_EQ(covered_inside(frame, 11, 6, 20, 15), 100U);
  EXPECT_EQ(frame.covered(), 100U);
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
    const bool flip = random() % 2 == 0;
    const std::uint32_t a = index(i + (flip ? 1 : 0), j);
    const std::uint32_t b = index(i + (flip ? 1 : 0), j + 1);
    const std::uint32_t c = index(i + (flip ? 0 : 1), j + 1);
    const std::uint32_t d = index(i + (flip ? 0 : 1), j);
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back(random() % 2 == 0 ? std::array{b, c, d} : std::array{b, d, c});
    if (flip) std::swap(mesh.triangles.back(), mesh.triangles[mesh.triangles.size() - 2]);
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

}  // namespace
}  // namespace penumbra::test
