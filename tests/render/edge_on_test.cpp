// SPDX-License-Identifier: Apache-2.0
// Faces whose plane passes the camera's centre, and triangles of next to no area.
#include "render_test.hpp"
#include "shapes.hpp"

#include <penumbra/mesh/primitives.hpp>

namespace penumbra::test {
namespace {

PENUMBRA_RENDER_TEST(EdgeOn, 2);

/// With a face in the plane of the camera's centre on pixel centres, and between them.
const std::array<Intrinsics, 3> cameras{Intrinsics(320, 240, 300.0, 300.0, 160.0, 120.0),
                                        Intrinsics(160, 120, 150.0, 155.0, 81.3, 57.9),
                                        Intrinsics(160, 120, 150.0, 150.0, 80.5, 59.5)};

/// Whether any of the pixels at most one pixel away, or all of them, show something.
std::pair<bool, bool> any_and_all_around(const Image<float>& depth, int u, int v) {
  bool any = false, all = true;
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, depth.height() - 1); ++y)
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, depth.width() - 1); ++x)
      (depth(x, y) > 0.0F ? any : all) = depth(x, y) > 0.0F;
  return {any, all};
}

/// The least and largest depth of the scene's corners, with the renderers' tolerance.
std::pair<double, double> depth_range(const Scene& scene) {
  double low = inf, high = -inf;
  const std::vector<Body> bodies = scene.bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const TriangleMesh& mesh : bodies[i].meshes)
      for (const Vector3f& vertex : mesh.vertices) {
        const double z = (scene.poses[i] * vertex.cast<double>()).z();
        low = std::min(low, z);
        high = std::max(high, z);
      }
  return {std::max(low, DepthRenderer::near_plane) * (1.0 - interior_tolerance),
          high * (1.0 + interior_tolerance)};
}

/// Pixels whose depth is none that the scene has.
std::size_t impossible_depths(const Frame& frame, const Scene& scene) {
  const auto [low, high] = depth_range(scene);
  return std::size_t(std::count_if(
      frame.depth.data(), frame.depth.data() + frame.depth.size(),
      [low = low, high = high](float z) { return z != 0.0F && !(z >= low && z <= high); }));
}

/// Expects coverage at most one pixel from the reference's, and no depth that no corner could have.
/// Where a face is edge-on to the last bit its depth is any of that face along the pixel's column
/// or row, so brute force has no word on it.
void expect_like_reference(const Frame& frame, const Scene& scene, const Intrinsics& camera) {
  const Frame reference(
      make({Backend::reference, "", 1}, camera, scene.bodies())->render(scene.poses));
  std::size_t beyond = 0, missing = 0;
  for (const auto [u, v] : each_pixel(camera)) {
    const auto [any, all] = any_and_all_around(reference.depth, u, v);
    const bool covered = frame.depth(u, v) > 0.0F;
    beyond += covered && !any ? 1 : 0;
    missing += !covered && all ? 1 : 0;
  }
  EXPECT_EQ(beyond, 0U);
  EXPECT_EQ(missing, 0U);
  EXPECT_EQ(impossible_depths(frame, scene), 0U);
}

/// A box or a cylinder about the origin, and half of its size along y but for its rounding to
/// float.
std::pair<TriangleMesh, double> random_solid(std::mt19937_64& random, bool round) {
  const double half = uniform(random, 0.05, 0.45), across = uniform(random, 0.05, 0.45);
  if (!round) {
    const TriangleMesh mesh =
        box(Vector3d(across, half, uniform(random, 0.05, 0.45)).cast<float>());
    return {mesh, half};
  }
  TriangleMesh mesh = make_cylinder(across, 2.0 * half);
  for (Vector3f& p : mesh.vertices) p = Vector3f(p.x(), p.z(), -p.y());
  return {mesh, half};
}

/// The mesh with its corners where the pose has them, as a URDF's origin moves them.
TriangleMesh moved(TriangleMesh mesh, const Isometry3d& pose) {
  for (Vector3f& p : mesh.vertices) p = (pose * p.cast<double>()).cast<float>();
  return mesh;
}

TEST_P(EdgeOn, FacesInThePlaneOfTheCamerasCentre) {
  std::mt19937_64 random = seeded_random(71);
  for (int i = 0; i < samples(120); ++i) {
    const auto [mesh, half] = random_solid(random, i % 2 == 1);
    // Its face lies along the rows, mostly, along the columns, across both, or anyhow.
    const std::array<double, 6> turns{0.0,      M_PI,         M_PI / 2.0,
                                      M_PI / 4, -0.75 * M_PI, uniform(random, -M_PI, M_PI)};
    const double turned = i % 3 == 0 ? turns[random() % turns.size()] : 0.0;
    const Vector3d place(uniform(random, -0.3, 0.3), i % 4 < 2 ? half : -half,
                         uniform(random, -0.7, 0.4));
    Scene scene;
    scene.add(moved(mesh, at(place)), AngleAxisd(turned, Vector3d::UnitZ()) * at(0, 0, 2));
    const Intrinsics& camera = cameras[random() % cameras.size()];
    SCOPED_TRACE(::testing::Message() << "scene " << i << ", cx " << camera.cx());
    expect_like_reference(render(camera, scene), scene, camera);
  }
}

TEST_P(EdgeOn, SpheresSmallerThanAPixel) {
  for (const Intrinsics& camera : cameras)
    for (const float radius : {1e-9F, 1e-8F, 1e-7F, 1e-6F, 1e-5F, 1e-4F, 1e-3F})
      for (const double shift : {0.0, 0.3}) {
        Scene scene;
        scene.add(sphere(radius, 12), at(camera.ray(70 + shift, 50) * 2.0));
        const Frame frame = render(camera, scene);
        EXPECT_LE(frame.covered(), 1U) << radius;
        EXPECT_EQ(impossible_depths(frame, scene), 0U) << radius;
        if (shift > 0.0) {
          EXPECT_EQ(frame.covered(), 0U) << radius;
        } else if (radius > 1e-4F) {
          EXPECT_EQ(frame.covered(), 1U) << radius;
        }
      }
}

/// A triangle in the image, with its corners' depths.
struct ImageTriangle {
  std::array<Vector3d, 3> corners;  // in the camera's frame

  [[nodiscard]] double distance(const Intrinsics& camera, const Vector2d& p) const {
    std::array<Vector2d, 3> q;
    for (std::size_t i = 0; i < 3; ++i) q[i] = camera.project(corners[i]);
    double nearest = inf;
    int left = 0, right = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector2d edge = q[(i + 1) % 3] - q[i];
      const Vector2d to = p - q[i];
      const double cross = edge.x() * to.y() - edge.y() * to.x();
      (cross >= 0 ? left : right) += 1;
      const double t = std::clamp(to.dot(edge) / std::max(edge.squaredNorm(), 1e-30), 0.0, 1.0);
      nearest = std::min(nearest, (to - edge * t).norm());
    }
    return left == 3 || right == 3 ? 0.0 : nearest;
  }
};

/// A triangle whose plane passes the camera's centre, or very nearly: its image lies along a line
/// through pixel centres, or anyhow.
ImageTriangle random_edge_on(std::mt19937_64& random, const Intrinsics& camera) {
  const std::array<Vector2d, 6> along{
      Vector2d(1, 0),  Vector2d(0, 1), Vector2d(1, 1),
      Vector2d(1, -1), Vector2d(2, 1), Vector2d(uniform(random, -1, 1), uniform(random, -1, 1))};
  const Vector2d& direction = along[random() % along.size()];
  const Vector2d start(std::floor(uniform(random, 40, 120)), std::floor(uniform(random, 30, 90)));
  const double extent = std::pow(10.0, uniform(random, -3.0, 2.0));
  const std::array<double, 5> heights{0.0, 1e-6, 1e-4, 1e-3, 1e-2};
  const double height = heights[random() % heights.size()];
  const bool whole = random() % 3 == 0;  // corners on pixel centres too
  ImageTriangle result;
  for (Vector3d& corner : result.corners) {
    double t = uniform(random, -extent, extent);
    if (whole) t = std::round(t);
    const Vector2d across = Vector2d(-direction.y(), direction.x()) * uniform(random, 0.0, height);
    const Vector2d q = start + direction * t + across;
    corner = camera.ray(q.x(), q.y()) * uniform(random, 0.3, 3.0);
  }
  return result;
}

TEST_P(EdgeOn, RandomTrianglesStayOnTheirLines) {
  if (GetParam().backend == Backend::gl) GTEST_SKIP() << "the device's own depths and pixel grid";
  // The reference looks one pixel around what it projects.
  const double reach = GetParam().backend == Backend::cpu ? 1e-3 : 1.5;  // pixels
  std::mt19937_64 random = seeded_random(72);
  std::size_t drawn = 0;
  for (int i = 0; i < samples(300); ++i) {
    const Intrinsics& camera = cameras[random() % cameras.size()];
    const ImageTriangle triangle_of = random_edge_on(random, camera);
    const auto& [a, b, c] = triangle_of.corners;
    Scene scene;
    // In the frame of a body that is turned, so that no coordinate is a round number.
    const Isometry3d pose = i % 2 == 0 ? Isometry3d::Identity()
                                       : random_pose(random, {-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5});
    const Isometry3d back = pose.inverse();
    scene.add(
        triangle((back * a).cast<float>(), (back * b).cast<float>(), (back * c).cast<float>()),
        pose);
    const Frame frame = render(camera, scene);
    SCOPED_TRACE(::testing::Message() << "triangle " << i);
    EXPECT_EQ(impossible_depths(frame, scene), 0U);
    std::size_t astray = 0;
    for (const auto [u, v] : each_pixel(camera)) {
      if (frame.depth(u, v) == 0.0F) continue;
      ++drawn;
      astray += triangle_of.distance(camera, Vector2d(u, v)) > reach ? 1 : 0;
    }
    EXPECT_EQ(astray, 0U);
  }
  std::cout << drawn << " pixels\n";
  EXPECT_GT(drawn, 0U);
}

TEST_P(EdgeOn, SolidsOfSliversTurnedAboutTheCamera) {
  std::mt19937_64 random = seeded_random(73);
  for (int i = 0; i < samples(30); ++i) {
    const auto [mesh, half] = random_solid(random, true);
    // The face's plane passes the centre up to rounding; the view direction does not lie in it.
    const Vector3d place(uniform(random, -0.2, 0.2), half, uniform(random, 1.2, 2.0));
    Scene scene;
    scene.add(mesh, AngleAxisd(uniform(random, -0.3, 0.3), random_direction(random)) * at(place));
    const Intrinsics& camera = cameras[random() % cameras.size()];
    SCOPED_TRACE(::testing::Message() << "scene " << i);
    const Frame frame = render(camera, scene);
    expect_like_reference(frame, scene, camera);
    if (GetParam().backend == Backend::cpu)
      expect_agrees_with_brute_force(frame.view(), scene, camera);
  }
}

}  // namespace
}  // namespace penumbra::test
