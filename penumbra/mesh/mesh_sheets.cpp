// SPDX-License-Identifier: Apache-2.0
// Why few backs of a sheet with holes can be seen: let caps inside the balls around its rims close
// it. The number of times that the capped sheet winds around a point changes by one where a ray
// passes the sheet, from before a front to behind it. It is 0 outside; where it is not negative
// before any front, a ray from outside that met no ball meets a front first. As long as the sheet
// does not cross itself, that number is the same all along a part of it that no ball touches, so
// that one point of each part tells; some more are tried since sheets do cross themselves.
// Triangles that touch a ball are not asked: who skips backs must draw both sides of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include <penumbra/mesh/mesh_edges-inl.hpp>
#include <penumbra/mesh/mesh_sheets.hpp>
#include <penumbra/mesh/solid_angle-inl.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;

// Above these a sheet counts as open: drawing both of its sides costs less than finding out.
constexpr std::size_t most_rim_edges = 256;
constexpr std::size_t most_holes = 8;
constexpr double most_radii = 0.125;           // of the sheet's size
constexpr std::size_t most_work = 40'000'000;  // samples times triangles: a second or two
constexpr std::size_t usual_work = 500'000;
constexpr std::size_t most_spread = 256;  // samples beside those of the parts

/// A run of a triangle along an edge that is not regular.
struct RimEdge {
  std::uint32_t from, to;
};

/// A sheet's holes, each closed by a cone from the middle of the ball around its rim.
struct Caps {
  std::vector<Ball> balls;
  std::vector<std::array<Vector3d, 3>> triangles;
};

/// The connected parts of a sheet's rim.
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
  constexpr double spare = 1.01;  // for the roundings of those who use it
  return {box.center(), radius * spare};
}

double size_of(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  Eigen::AlignedBox3d bounds;
  for (const std::size_t i : triangles) {
    for (const Vector3d& p : corners_of(mesh, i)) bounds.extend(p);
  }
  return bounds.diagonal().norm();
}

/// Caps for a sheet's rim; none where its holes are not small.
std::optional<Caps> make_caps(const TriangleMesh& mesh, const MeshSheet& sheet,
                              const std::vector<RimEdge>& edges) {
  if (edges.size() > most_rim_edges) return std::nullopt;
  Caps caps;
  double room = most_radii * size_of(mesh, sheet.triangles);
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

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double t = (p - a).dot(b - a) / (b - a).squaredNorm();
  return (a + std::clamp(t, 0.0, 1.0) * (b - a) - p).norm();
}

double distance_to_triangle(const Vector3d& p, const std::array<Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vector3d n = (b - a).cross(c - a);
  const bool above = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                     n.dot((a - c).cross(p - c)) >= 0;
  if (above) return std::abs(n.dot(p - a)) / n.norm();
  return std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

bool touches(const std::vector<Ball>& balls, const std::array<Vector3d, 3>& corners) {
  return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return distance_to_triangle(ball.centre, corners) <= ball.radius;
  });
}

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = corners_of(mesh, triangle);
  return (b - a).cross(c - a).norm() / 2.0;
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

/// `count` points spread evenly over the area of some triangles, by the additive sequence of
/// Roberts 2018, "The unreasonable effectiveness of quasirandom sequences".
std::vector<Sample> spread_over(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles,
                                std::size_t count) {
  double whole = 0.0;
  for (const std::size_t i : triangles) whole += area_of(mesh, i);
  const double step = whole / static_cast<double>(count);
  std::vector<Sample> samples;
  double passed = 0.0;
  for (const std::size_t i : triangles) {
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

/// Which way the front of the sheet faces at a sample, by how often the capped sheet winds around
/// the points before and behind it.
Facing facing_at(const Sample& sample, const TriangleMesh& mesh, const MeshSheet& sheet,
                 const Caps& caps) {
  double angle = 0.0;  // 4 pi for each time, half way between before and behind
  for (const std::size_t i : sheet.triangles) {
    if (i != sample.triangle) angle += solid_angle(corners_of(mesh, i), sample.point);
  }
  for (const auto& cap : caps.triangles) angle += solid_angle(cap, sample.point);
  const double before = (angle - 2.0 * std::numbers::pi) / (4.0 * std::numbers::pi);
  constexpr double rounding = 0.01;
  if (std::abs(before - std::round(before)) > rounding) return Facing::unknown;
  return before > -0.5 ? Facing::outwards : Facing::inwards;
}

/// The facing that all samples agree on.
Facing facing_of(const std::vector<Sample>& samples, const TriangleMesh& mesh,
                 const MeshSheet& sheet, const Caps& caps) {
  if (samples.empty() || samples.size() * sheet.triangles.size() > most_work) {
    return Facing::unknown;
  }
  const Facing facing = facing_at(samples.front(), mesh, sheet, caps);
  const bool same = std::all_of(samples.begin() + 1, samples.end(), [&](const Sample& sample) {
    return facing_at(sample, mesh, sheet, caps) == facing;
  });
  return same ? facing : Facing::unknown;
}

/// Points of the part of a sheet that no ball touches: the middle of the largest triangle of each
/// connected part, and some more.
std::vector<Sample> choose_samples(const TriangleMesh& mesh, const MeshSheet& sheet,
                                   const std::vector<bool>& touching, DisjointSets& parts) {
  std::vector<std::size_t> apart;
  std::map<std::uint32_t, std::pair<double, std::size_t>> largest;  // area and triangle, by part
  for (const std::size_t i : sheet.triangles) {
    if (touching[i]) continue;
    apart.push_back(i);
    auto& best = largest[parts.find(static_cast<std::uint32_t>(i))];
    best = std::max(best, {area_of(mesh, i), i});
  }
  const std::size_t spread = usual_work / sheet.triangles.size();
  std::vector<Sample> samples =
      spread_over(mesh, apart, std::clamp(spread, MeshSheet::least_samples, most_spread));
  for (const auto& [part, best] : largest) samples.push_back(middle_of(mesh, best.second));
  return samples;
}

/// The sheets, and the rims of those that are not closed, by their first triangles.
struct SplitMesh {
  std::vector<MeshSheet> sheets;
  std::map<std::size_t, std::vector<RimEdge>> rims;
};

SplitMesh split_mesh(const TriangleMesh& welded, EdgeUses& edges) {
  DisjointSets sets(welded.triangles.size());
  std::vector<std::pair<std::uint32_t, RimEdge>> rim_runs;  // by triangles
  for_each_edge(edges, [&](std::uint32_t lower, const EdgeUse* begin, const EdgeUse* end) {
    if (is_regular(begin, end)) {
      sets.join(begin[0].triangle / 2, begin[1].triangle / 2);
      return;
    }
    for (const EdgeUse* use = begin; use < end; ++use) {
      const bool falls = (use->triangle & 1) != 0;
      rim_runs.emplace_back(use->triangle / 2,
                            falls ? RimEdge{use->upper, lower} : RimEdge{lower, use->upper});
    }
  });
  SplitMesh mesh;
  for (const auto& [triangle, edge] : rim_runs) mesh.rims[sets.find(triangle)].push_back(edge);
  for (std::vector<std::size_t>& triangles : sets.members()) {
    MeshSheet& sheet = mesh.sheets.emplace_back();
    sheet.triangles = std::move(triangles);
    sheet.closed = !mesh.rims.contains(sheet.triangles.front());
  }
  return mesh;
}

}  // namespace

std::vector<MeshSheet> split_sheets(const TriangleMesh& welded) {
  EdgeUses edges = collect_edges(welded);
  return split_mesh(welded, edges).sheets;
}

std::vector<MeshSheet> mesh_sheets(const TriangleMesh& welded) {
  const std::size_t count = welded.triangles.size();
  EdgeUses edges = collect_edges(welded);
  auto [sheets, rims] = split_mesh(welded, edges);
  std::vector<std::pair<std::size_t, Caps>> capped;  // with the sheets' numbers
  std::vector<bool> touching(count, false);
  for (std::size_t number = 0; number < sheets.size(); ++number) {
    const MeshSheet& sheet = sheets[number];
    std::optional<Caps> caps =
        sheet.closed ? Caps{} : make_caps(welded, sheet, rims[sheet.triangles.front()]);
    if (!caps) continue;
    for (const std::size_t i : sheet.triangles) {
      touching[i] = touches(caps->balls, corners_of(welded, i));
    }
    capped.emplace_back(number, *std::move(caps));
  }

  DisjointSets parts(count);
  for_each_edge(edges, [&](std::uint32_t /*lower*/, const EdgeUse* begin, const EdgeUse* end) {
    if (!is_regular(begin, end)) return;
    const std::uint32_t a = begin[0].triangle / 2;
    const std::uint32_t b = begin[1].triangle / 2;
    if (!touching[a] && !touching[b]) parts.join(a, b);
  });
  for (auto& [number, caps] : capped) {
    MeshSheet& sheet = sheets[number];
    const auto samples = choose_samples(welded, sheet, touching, parts);
    sheet.facing = facing_of(samples, welded, sheet, caps);
    if (sheet.facing != Facing::unknown) sheet.holes = std::move(caps.balls);
  }
  return sheets;
}

}  // namespace penumbra
