// SPDX-License-Identifier: Apache-2.0
#include "../robot/urdf_text.hpp"
#include "../support/data.hpp"
#include "../support/shapes.hpp"
#include "mesh_oracle.hpp"

#include <penumbra/mesh/mesh_file.hpp>
#include <penumbra/mesh/primitives.hpp>
#include <penumbra/mesh/surface_offset.hpp>

namespace penumbra::test {
namespace {

constexpr double most_missing = 0.002;  // metres

PreparedMesh offset_surface(const TriangleMesh& mesh, double margin) {
  return penumbra::offset_surface(PreparedMesh(mesh), margin);
}

void append(TriangleMesh& mesh, TriangleMesh other, const Vector3d& shift) {
  for (auto& v : other.vertices) v += shift.cast<float>();
  test::append(mesh, other);
}

/// A polygon in x, y (counter-clockwise, star-shaped about its first corner), extruded to height.
TriangleMesh extrude(const std::vector<Vector2d>& polygon, double height) {
  TriangleMesh mesh;
  const auto n = std::uint32_t(polygon.size());
  for (const double z : {0.0, height})
    for (const auto& p : polygon) mesh.vertices.push_back(Vector3d(p.x(), p.y(), z).cast<float>());
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
    if (i == 0 || j == 0) continue;
    mesh.triangles.push_back({0, j, i});
    mesh.triangles.push_back({n, n + i, n + j});
  }
  return mesh;
}

TriangleMesh l_shape() {
  return extrude({{0, 0}, {0.2, 0}, {0.2, 0.05}, {0.05, 0.05}, {0.05, 0.2}, {0, 0.2}}, 0.1);
}

/// A block with a fin: thin and pointed.
TriangleMesh finned(double thickness) {
  return extrude({{0, 0}, {0.08, 0}, {0.08, thickness}, {0.04, thickness}, {0.03, 0.05}, {0, 0.04}},
                 0.03);
}

/// A sphere whose vertices are moved in and out at random: sharp, convex and concave everywhere.
TriangleMesh crumpled(double amount) {
  auto random = seeded_random(32);
  TriangleMesh mesh = make_sphere(0.003);
  std::uniform_real_distribution<float> stretch(float(1 - amount), 1.0F);
  for (auto& v : mesh.vertices) v *= 30.0F * stretch(random);
  return mesh;
}

/// Points within the margin, but for most_missing, lie inside; no seen point lies far beyond it.
void expect_grown(const TriangleMesh& mesh, const PreparedMesh& grown, double margin, int count) {
  auto random = seeded_random(31);
  for (int i = 0; i < samples(count); ++i) {
    const double reach = std::max(margin - most_missing, 0.25 * margin);
    const Vector3d p = random_point(mesh, random) + reach * random_direction(random);
    ASSERT_TRUE(windings(grown, p) > 0 || windings(mesh, p) != 0) << p.transpose();
  }
  std::vector<double> excess;
  for (int i = 0; i < samples(count); ++i) {
    const Vector3d eye =
        grown.bounds.center() + 2 * grown.bounds.diagonal().norm() * random_direction(random);
    const Vector3d ray = random_point(mesh, random) - eye;
    double first = 1e9;
    for (const auto& crossing : crossings(grown, eye, ray)) first = std::min(first, crossing.t);
    ASSERT_LT(first, 1.0);
    excess.push_back(distance(mesh, eye + first * ray) - margin);
  }
  std::sort(excess.begin(), excess.end());
  const double usual = excess[excess.size() * 95 / 100];
  std::cout << mesh.triangles.size() << " -> " << grown.triangles.size() << " triangles, margin "
            << 1e3 * margin << " mm, off by " << 1e3 * excess.front() << " to " << 1e3 * usual
            << " (95 %) and " << 1e3 * excess.back() << " mm\n";
  EXPECT_GE(excess.front(), -0.0005);
  EXPECT_LE(usual, 0.002);
  EXPECT_LE(excess.back(), 0.006);
}

/// Points of the result lie inside the mesh, deep enough; points that are deeper lie inside it.
void expect_shrunk(const TriangleMesh& mesh, const TriangleMesh& shrunk, double depth, int count) {
  ASSERT_FALSE(shrunk.triangles.empty());
  auto random = seeded_random(41);
  double least = 1.0;
  for (int i = 0; i < samples(count); ++i) {
    const Vector3d p = random_point(shrunk, random);
    const double away = distance(mesh, p);
    least = std::min(least, (windings(mesh, p) != 0 ? away : -away) - depth);
  }
  EXPECT_GE(least, -0.0015);
  const Eigen::AlignedBox3d box = PreparedMesh(mesh).bounds;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int deep = 0;
  for (int i = 0; i < samples(4 * count); ++i) {
    const Vector3d u{share(random), share(random), share(random)};
    const Vector3d p = box.min() + u.cwiseProduct(box.sizes());
    if (windings(mesh, p) == 0 || distance(mesh, p) < depth + 0.003) continue;
    ++deep;
    ASSERT_GT(windings(shrunk, p), 0) << p.transpose();
  }
  std::cout << mesh.triangles.size() << " -> " << shrunk.triangles.size() << " triangles, depth "
            << 1e3 * depth << " mm, too large by " << -1e3 * least << " mm, " << deep
            << " points inside\n";
  EXPECT_TRUE(deep > 0 || sanitized) << "a sanitizer's few points may all lie outside";
}

/// All of them; the last, which costs least, where a sanitizer watches.
std::vector<double> margins(const std::vector<double>& all) {
  return sanitized ? std::vector<double>{all.back()} : all;
}

TEST(Offset, SolidsGrow) {
  TriangleMesh several = make_box({0.1, 0.1, 0.1});
  append(several, make_sphere(0.03), {0.06, 0, 0});
  append(several, {{{0, 0, 0}, {0.2F, 0, 0}, {0, 0.2F, 0}}, {{0, 1, 2}}}, {0, 0, 0.1});
  const TriangleMesh needle = {
      {{0, 0, 0.3F}, {0.002F, 0, 0}, {0, 0.002F, 0}, {-0.002F, -0.001F, 0}},
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  for (const double margin : margins({0.001, 0.01, 0.03}))
    for (const TriangleMesh& mesh :
         {mirrored(make_box({0.3, 0.2, 0.1})), make_cylinder(0.04, 0.1), l_shape(), finned(0.002),
          crumpled(0.1), crumpled(0.6), several, needle})
      expect_grown(mesh, offset_surface(mesh, margin), margin, 300);
}

TEST(Offset, OpenMeshesGrowOnBothSidesAndAreClosed) {
  TriangleMesh open_box = make_box({0.3, 0.2, 0.1});
  open_box.triangles.resize(9);
  const TriangleMesh sheet = {{{0, 0, 0}, {0.2F, 0.1F, 0}, {0, 0.2F, 0.1F}}, {{0, 1, 2}}};
  TriangleMesh fins = sheet;  // three more triangles at one edge, one wound the wrong way
  fins.vertices.insert(fins.vertices.end(),
                       {{0.1F, 0, 0.2F}, {0.1F, -0.1F, 0.1F}, {0.1F, 0.1F, 0.2F}});
  fins.triangles.insert(fins.triangles.end(), {{0, 1, 3}, {1, 0, 4}, {0, 1, 5}});
  for (const double margin : margins({0.0005, 0.005}))
    for (const TriangleMesh& mesh : {open_box, sheet, fins})
      expect_grown(mesh, offset_surface(mesh, margin), margin, 300);
}

TEST(Offset, SolidsShrinkAndDetailsVanish) {
  TriangleMesh two = make_box({0.1, 0.1, 0.1});
  append(two, make_sphere(0.03), {0, 0.1, 0});
  for (const double depth : margins({0.0005, 0.002, 0.01}))
    for (const TriangleMesh& mesh : {mirrored(make_box({0.3, 0.2, 0.1})), make_cylinder(0.04, 0.1),
                                     l_shape(), finned(0.003), crumpled(0.4), two})
      expect_shrunk(mesh, offset_surface(mesh, -depth), depth, 300);
}

TEST(Offset, TooFineAMarginIsRefused) {
  expect_refused([] { (void)offset_surface(make_box({100, 50, 1}), 0.01); }, {"10 mm"});
  for (const double none : {nan, HUGE_VAL})
    expect_refused([&] { (void)offset_surface(make_sphere(1), none); }, {});
}

std::vector<std::filesystem::path> mesh_files() {
  const auto robots = data_folder() / "robots";
  std::vector<std::filesystem::path> files;
  for (const char* folder :
       {"ur5e/ur_description/meshes/ur5e/collision", "xarm7/xarm_description/meshes/xarm7/visual"})
    for (const auto& entry : std::filesystem::directory_iterator(robots / folder))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (measures_in_full()) return files;
  return {files.front(), files.back()};
}

TEST(Offset, RealLinks) {
  PENUMBRA_REQUIRE_DATA();
  for (const auto& file : mesh_files()) {
    const TriangleMesh mesh = load_mesh(file);
    std::cout << file.filename() << '\n';
    for (const double margin : margins({0.002, 0.01, 0.03})) {
      const PreparedMesh grown = offset_surface(mesh, margin);
      expect_grown(mesh, grown, margin, 200);
      EXPECT_LT(grown.triangles.size(), mesh.triangles.size() + 3000);
    }
    if (PreparedMesh(mesh).watertight)
      expect_shrunk(mesh, offset_surface(mesh, -0.005), 0.005, 200);
  }
}

}  // namespace
}  // namespace penumbra::test
