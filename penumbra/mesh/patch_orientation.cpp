// SPDX-License-Identifier: Apache-2.0
// A patch with small holes still hides its back sides. Caps inside balls around its holes close it.
// Along a ray, the winding number of the capped patch changes by one at each crossing, and it is 0
// outside. If it is not negative in front of any front face, a ray from outside that passed no ball
// meets a front face first. The winding number is constant along a part of the patch that no ball
// touches, unless the patch crosses itself, so one point of each part is tested, and a few more.
// Triangles that touch a ball are not tested: a renderer must draw both of their sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>

#include <penumbra/mesh/surface_patches.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;

// A patch beyond these limits counts as open: drawing both of its sides is cheaper than the test.
constexpr std::size_t most_rim_edges = 256;
constexpr std::size_t most_holes = 8;
constexpr double most_radii = 0.125;           // of the patch's size
constexpr std::size_t most_work = 40'000'000;  // samples times triangles: tenths of a second
constexpr std::size_t usual_work = 500'000;
constexpr std::size_t least_spread = 4;  // samples besides those of the parts
constexpr std::size_t most_spread = 256;

/// The holes of a patch, each closed by a cone from the centre of the ball around its rim.
struct Caps {
  std::vector<Ball> balls;
  std::vector<std::array<Vector3d, 3>> triangles;
};

/// Returns the connected parts of a patch's rim.
std::vector<std::vector<RimEdge>> split_rim(const std::vector<RimEdge>& edges) {
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const RimEdge& e : edges) {
    numbers.emplace(e.from, static_cast<std::uint32_t>(numbers.size()));
    numbers.emplace(e.to, static_cast<std::uint32_t>(numbers.size()));
  }
  DisjointSets sets(numbers.size());
  for (const RimEdge& e : edges) sets.join(numbers[e.from], numbers[e.to]);
  std::map<std::uint32_t, std::vector<RimEdge>> parts;
  for (const RimEdge& e : edges) parts[sets.find(numbers[e.from])].push_back(e);
  std::vector<std::vector<RimEdge>> rims;
  rims.reserve(parts.size());
  for (auto& [set, part] : parts) rims.push_back(std::move(part));
  return rims;
}

Ball ball_around(const TriangleMesh& mesh, const std::vector<RimEdge>& rim) {
  Eigen::AlignedBox3d box;
  for (const RimEdge& e : rim) {
    box.extend(mesh.vertices[e.from].cast<double>());
    box.extend(mesh.vertices[e.to].cast<double>());
  }
  double radius = 0.0;
  for (const RimEdge& e : rim) {
    for (const std::uint32_t v : {e.from, e.to}) {
      radius = std::max(radius, (mesh.vertices[v].cast<double>() - box.center()).norm());
    }
  }
  constexpr double spare = 1.01;  // for rounding
  return {box.center(), radius * spare};
}

/// Returns caps for a patch's rim, or nothing if its holes are not small.
std::optional<Caps> make_caps(const TriangleMesh& mesh, const SurfacePatch& patch,
                              const std::vector<RimEdge>& edges) {
  if (edges.size() > most_rim_edges) return std::nullopt;
  Caps caps;
  double room = most_radii * patch.bounds.diagonal().norm();
  for (const std::vector<RimEdge>& rim : split_rim(edges)) {
    const Ball& ball = caps.balls.emplace_back(ball_around(mesh, rim));
    room -= ball.radius;
    for (const RimEdge& e : rim) {
      caps.triangles.push_back(
          {mesh.vertices[e.to].cast<double>(), mesh.vertices[e.from].cast<double>(), ball.centre});
    }
  }
  if (room < 0.0 || caps.balls.size() > most_holes) return std::nullopt;
  return caps;
}

bool touches(const std::vector<Ball>& balls, const std::array<Vector3d, 3>& corners) {
  return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return distance_to_triangle(ball.centre, corners) <= ball.radius;
  });
}

/// Twice as long as the triangle's area.
Vector3d normal_of(const std::array<Vector3d, 3>& corners) {
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

Sample middle_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = corners_of(mesh, triangle);
  return {triangle, (a + b + c) / 3.0};
}

/// Returns `count` points spread evenly over the area of some triangles, by the additive sequence
/// of Roberts 2018, "The unreasonable effectiveness of quasirandom sequences".
std::vector<Sample> spread_over(const TriangleMesh& mesh,
                                const std::vector<std::uint32_t>& triangles, std::size_t count) {
  double whole = 0.0;
  for (const std::uint32_t i : triangles) whole += area_of(mesh, i);
  const double step = whole / static_cast<double>(count);
  std::vector<Sample> samples;
  double passed = 0.0;
  for (const std::uint32_t i : triangles) {
    passed += area_of(mesh, i);
    const auto [a, b, c] = corners_of(mesh, i);
    while (samples.size() < count && (static_cast<double>(samples.size()) + 0.5) * step <= passed) {
      const double n = static_cast<double>(samples.size()) + 0.5;
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
int winding_around(const Vector3d& p, Eigen::Index axis, const std::array<Vector3d, 3>& corners) {
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

/// Returns whether the capped patch's winding number is not negative in front of a sample. It is
/// the sum of what a ray crosses, here along the axis next to the normal. `boxes` are those of the
/// patch's triangles.
bool faces_outwards(const Sample& sample, const TriangleMesh& mesh, const SurfacePatch& patch,
                    const std::vector<Eigen::AlignedBox3f>& boxes, const Caps& caps) {
  const Vector3d front = normal_of(corners_of(mesh, sample.triangle));
  Eigen::Index axis = 0;
  front.cwiseAbs().maxCoeff(&axis);
  int sum = 0;
  const auto cross = [&](const std::array<Vector3d, 3>& corners) {
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
  for (const auto& cap : caps.triangles) cross(cap);
  return front[axis] > 0.0 ? sum >= 0 : sum <= 0;
}

/// Returns the facing that all samples agree on.
Facing facing_of(const std::vector<Sample>& samples, const TriangleMesh& mesh,
                 const SurfacePatch& patch, const Caps& caps) {
  if (samples.empty() || samples.size() * patch.triangles.size() > most_work)
    return Facing::unknown;
  std::vector<Eigen::AlignedBox3f> boxes(patch.triangles.size());
  for (std::size_t k = 0; k < boxes.size(); ++k)
    for (const std::uint32_t vertex : mesh.triangles[patch.triangles[k]])
      boxes[k].extend(mesh.vertices[vertex]);
  const auto is_outwards = [&](const Sample& sample) {
    return faces_outwards(sample, mesh, patch, boxes, caps);
  };
  const bool first = is_outwards(samples.front());
  const bool same = std::all_of(samples.begin() + 1, samples.end(),
                                [&](const Sample& sample) { return is_outwards(sample) == first; });
  return !same ? Facing::unknown : first ? Facing::outwards : Facing::inwards;
}

/// Returns points of the part of a patch that no ball touches: the middle of the largest triangle
/// of each connected part, and some spread over all of it.
std::vector<Sample> choose_samples(const TriangleMesh& mesh, const SurfacePatch& patch,
                                   const std::vector<bool>& touching, DisjointSets& parts) {
  std::vector<std::uint32_t> apart;
  std::map<std::uint32_t, std::pair<double, std::uint32_t>> largest;  // area, triangle; by part
  for (const std::uint32_t i : patch.triangles) {
    if (touching[i]) continue;
    apart.push_back(i);
    auto& best = largest[parts.find(i)];
    best = std::max(best, {area_of(mesh, i), i});
  }
  const std::size_t spread = usual_work / patch.triangles.size();
  std::vector<Sample> samples =
      spread_over(mesh, apart, std::clamp(spread, least_spread, most_spread));
  for (const auto& [part, best] : largest) samples.push_back(middle_of(mesh, best.second));
  return samples;
}

}  // namespace

std::vector<PatchOrientation> orient(const PreparedMesh& mesh, const Connections& connections) {
  std::vector<std::size_t> patch_of(mesh.triangles.size());
  for (std::size_t number = 0; number < mesh.patches.size(); ++number)
    for (const std::uint32_t i : mesh.patches[number].triangles) patch_of[i] = number;
  std::vector<std::vector<RimEdge>> rims(mesh.patches.size());
  for (const RimEdge& edge : connections.rim) rims[patch_of[edge.triangle]].push_back(edge);

  std::vector<std::optional<Caps>> caps;        // of each patch
  std::vector<bool> touching(patch_of.size());  // a ball
  for (std::size_t number = 0; number < mesh.patches.size(); ++number) {
    const SurfacePatch& patch = mesh.patches[number];
    caps.push_back(make_caps(mesh, patch, rims[number]));
    if (!caps.back()) continue;
    for (const std::uint32_t i : patch.triangles)
      touching[i] = touches(caps.back()->balls, corners_of(mesh, i));
  }

  DisjointSets parts(touching.size());
  for (const auto& [a, b] : connections.regular)
    if (!touching[a] && !touching[b]) parts.join(a, b);
  std::vector<PatchOrientation> orientations(mesh.patches.size());
  for (std::size_t number = 0; number < mesh.patches.size(); ++number) {
    if (!caps[number]) continue;
    const SurfacePatch& patch = mesh.patches[number];
    const auto samples = choose_samples(mesh, patch, touching, parts);
    const Facing facing = facing_of(samples, mesh, patch, *caps[number]);
    if (facing != Facing::unknown) orientations[number] = {facing, std::move(caps[number]->balls)};
  }
  return orientations;
}

}  // namespace penumbra
