// SPDX-License-Identifier: Apache-2.0
// Along a ray, the winding number of a closed surface changes by one at each crossing, and it is 0
// outside. If it is not negative in front of any front face, a ray from outside meets a front face
// first. The winding number is constant along a patch that does not cross itself: some points of
// each patch are tested. Small holes are closed by a cone from their rims to a common point.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <penumbra/mesh/surface_patches-inl.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

// A patch beyond these limits counts as open: drawing both of its sides is cheaper than the test.
constexpr std::size_t most_rim_edges = 256;
constexpr double most_hole_radius = 0.125;     // of the patch's size
constexpr std::size_t most_work = 40'000'000;  // samples times triangles: tenths of a second
constexpr std::size_t usual_work = 500'000;
constexpr std::size_t least_samples = 4;
constexpr std::size_t most_samples = 256;

/// Returns triangles that close a patch, from its rim to the rim's middle.
std::vector<Corners> cone_over(const TriangleMesh& mesh, const std::vector<RimEdge>& rim) {
  Vector3d middle = Vector3d::Zero();
  for (const RimEdge& e : rim)
    middle += mesh.vertices[e.from].cast<double>() / static_cast<double>(rim.size());
  std::vector<Corners> triangles;
  triangles.reserve(rim.size());
  for (const RimEdge& e : rim)
    triangles.push_back(
        {mesh.vertices[e.to].cast<double>(), mesh.vertices[e.from].cast<double>(), middle});
  return triangles;
}

/// Twice as long as the triangle's area.
Vector3d normal_of(const Corners& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  return normal_of(corners_of(mesh, triangle)).norm() / 2.0;
}

/// A point of a triangle.
struct Sample {
  std::size_t triangle;
  Vector3d point;
};

/// Returns the middle of a patch's largest triangle and points spread evenly over its area, by the
/// additive sequence of Roberts 2018, "The unreasonable effectiveness of quasirandom sequences".
std::vector<Sample> samples_of(const TriangleMesh& mesh, const SurfacePatch& patch) {
  double whole = 0.0, largest = -1.0;
  std::vector<Sample> samples(1);
  for (const std::uint32_t i : patch.triangles) {
    const double area = area_of(mesh, i);
    whole += area;
    if (area <= std::exchange(largest, std::max(largest, area))) continue;
    const auto [a, b, c] = corners_of(mesh, i);
    samples[0] = {i, (a + b + c) / 3.0};
  }
  const std::size_t count =
      std::clamp(usual_work / patch.triangles.size(), least_samples, most_samples);
  const double step = whole / static_cast<double>(count);
  double passed = 0.0;
  for (const std::uint32_t i : patch.triangles) {
    passed += area_of(mesh, i);
    const auto [a, b, c] = corners_of(mesh, i);
    while (samples.size() <= count &&
           (static_cast<double>(samples.size()) - 0.5) * step <= passed) {
      const double n = static_cast<double>(samples.size()) - 0.5;
      double s = std::fmod(0.7548776662466927 * n, 1.0);
      double t = std::fmod(0.5698402909980532 * n, 1.0);
      if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
      samples.push_back({i, a + s * (b - a) + t * (c - a)});
    }
  }
  return samples;
}

/// Returns the winding number of a triangle's outline around the line through a point along an
/// axis.
int winding_around(const Vector3d& p, Eigen::Index axis, const Corners& corners) {
  const Eigen::Index x = (axis + 1) % 3, y = (axis + 2) % 3;
  const std::array above{corners[0][y] > p[y], corners[1][y] > p[y], corners[2][y] > p[y]};
  if (above[0] == above[1] && above[1] == above[2]) return 0;
  int winding = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (above[k] == above[next]) continue;
    const Vector3d a = corners[k] - p, b = corners[next] - p;
    const bool is_left = a[x] * b[y] > b[x] * a[y];
    if (is_left == above[next]) winding += is_left ? 1 : -1;
  }
  return winding;
}

/// Returns whether the closed patch's winding number is not negative in front of a sample. It is
/// the sum of what a ray crosses, here along the axis next to the normal. `boxes` are those of the
/// patch's triangles.
bool faces_outwards(const Sample& sample, const TriangleMesh& mesh, const SurfacePatch& patch,
                    const std::vector<Eigen::AlignedBox3f>& boxes,
                    const std::vector<Corners>& cone) {
  const Vector3d front = normal_of(corners_of(mesh, sample.triangle));
  Eigen::Index axis = 0;
  front.cwiseAbs().maxCoeff(&axis);
  int sum = 0;
  const auto cross = [&](const Corners& corners) {
    const int winding = winding_around(sample.point, axis, corners);
    if (winding == 0) return;
    const Vector3d normal = normal_of(corners);
    const bool is_in_front =
        (normal.dot(corners[0] - sample.point) > 0.0) == (normal[axis] * front[axis] > 0.0);
    if (is_in_front) sum += winding;
  };
  const Eigen::Index x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double px = sample.point[x], py = sample.point[y];
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Eigen::Vector3f &least = boxes[k].min(), &most = boxes[k].max();
    const bool may_cross = least[x] <= px && px <= most[x] && least[y] <= py && py <= most[y];
    if (may_cross && patch.triangles[k] != sample.triangle)
      cross(corners_of(mesh, patch.triangles[k]));
  }
  for (const Corners& corners : cone) cross(corners);
  return front[axis] > 0.0 ? sum >= 0 : sum <= 0;
}

/// Returns the facing that all samples agree on.
Facing facing_of(const TriangleMesh& mesh, const SurfacePatch& patch,
                 const std::vector<RimEdge>& rim) {
  if (rim.size() > most_rim_edges ||
      patch.hole_radius() > most_hole_radius * patch.bounds.diagonal().norm())
    return Facing::unknown;
  const std::vector<Sample> samples = samples_of(mesh, patch);
  if (samples.size() * patch.triangles.size() > most_work) return Facing::unknown;
  const std::vector<Corners> cone = cone_over(mesh, rim);
  std::vector<Eigen::AlignedBox3f> boxes(patch.triangles.size());
  for (std::size_t k = 0; k < boxes.size(); ++k)
    for (const std::uint32_t vertex : mesh.triangles[patch.triangles[k]])
      boxes[k].extend(mesh.vertices[vertex]);
  const auto is_outwards = [&](const Sample& sample) {
    return faces_outwards(sample, mesh, patch, boxes, cone);
  };
  const bool first = is_outwards(samples.front());
  const bool same = std::all_of(samples.begin() + 1, samples.end(),
                                [&](const Sample& sample) { return is_outwards(sample) == first; });
  return !same ? Facing::unknown : first ? Facing::outwards : Facing::inwards;
}

}  // namespace

std::vector<Facing> find_facings(const PreparedMesh& mesh, const Connections& connections) {
  std::vector<std::size_t> patch_of(mesh.triangles.size());
  for (std::size_t number = 0; number < mesh.patches.size(); ++number)
    for (const std::uint32_t i : mesh.patches[number].triangles) patch_of[i] = number;
  std::vector<std::vector<RimEdge>> rims(mesh.patches.size());
  for (const RimEdge& edge : connections.rim) rims[patch_of[edge.triangle]].push_back(edge);
  std::vector<Facing> facings;
  for (std::size_t number = 0; number < mesh.patches.size(); ++number)
    facings.push_back(facing_of(mesh, mesh.patches[number], rims[number]));
  return facings;
}

}  // namespace penumbra
