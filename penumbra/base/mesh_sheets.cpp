// SPDX-License-Identifier: Apache-2.0
// Why a hole hides what it hides: let caps inside the balls around its rims close a sheet. A ray
// that meets no ball meets the sheet alone, and the number of times that the capped sheet winds
// around a point changes by one there. It is 0 outside; where it is 0 before every front and 1
// behind, a ray from outside meets a front first. Away from the balls the number before the front
// is the same all along the sheet, so that a few points tell.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include <penumbra/base/mesh_edges-inl.hpp>
#include <penumbra/base/mesh_sheets.hpp>
#include <penumbra/base/solid_angle-inl.hpp>

namespace penumbra {
namespace {

using Eigen::Vector3d;

// Above these a sheet counts as open: drawing both of its sides costs less than finding out.
constexpr std::size_t most_rim_edges = 256;
constexpr std::size_t most_holes = 8;
constexpr std::size_t most_samples = 512;
constexpr double most_radii = 0.125;  // of the sheet's size

/// A run of a triangle along an edge that is not regular.
struct RimEdge {
  std::uint32_t from, to;
};

/// A sheet's holes, each closed by a cone from the middle of the ball around its rim.
struct Caps {
  std::vector<Ball> balls;
  std::vector<std::array<Vector3d, 3>> triangles;
};

/// A point of a triangle.
struct Sample {
  std::size_t triangle;
  Vector3d point;
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

bool is_in(const std::vector<Ball>& balls, const Vector3d& point) {
  return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return (point - ball.centre).squaredNorm() <= ball.radius * ball.radius;
  });
}

/// Whether a box around the triangle meets one of the balls.
bool may_meet(const std::vector<Ball>& balls, const std::array<Vector3d, 3>& corners) {
  Eigen::AlignedBox3d box(corners[0]);
  box.extend(corners[1]);
  box.extend(corners[2]);
  return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return box.squaredExteriorDistance(ball.centre) <= ball.radius * ball.radius;
  });
}

/// Points that tell a capped sheet's sides: one of each part of it that no ball meets, in its
/// largest triangle, and those near the corners, outside of the balls, of the other triangles.
std::vector<Sample> choose_samples(const TriangleMesh& mesh, const MeshSheet& sheet,
                                   const Caps& caps, const std::vector<bool>& cut,
                                   DisjointSets& parts) {
  std::vector<Sample> samples;
  std::map<std::uint32_t, std::pair<double, std::size_t>> largest;  // area and triangle, by part
  for (const std::size_t i : sheet.triangles) {
    const auto corners = corners_of(mesh, i);
    const auto& [a, b, c] = corners;
    const Vector3d middle = (a + b + c) / 3.0;
    if (!cut[i]) {
      auto& best = largest[parts.find(static_cast<std::uint32_t>(i))];
      best = std::max(best, {(b - a).cross(c - a).norm(), i});
      continue;
    }
    for (const Vector3d& corner : corners) {
      constexpr double inwards = 0.01;  // from the corner, off the edges
      const Vector3d point = corner + inwards * (middle - corner);
      if (!is_in(caps.balls, point)) samples.push_back({i, point});
    }
  }
  for (const auto& [part, best] : largest) {
    const auto [a, b, c] = corners_of(mesh, best.second);
    samples.push_back({best.second, (a + b + c) / 3.0});
  }
  return samples;
}

/// Which way the sample's front faces. The capped sheet is seen under 4 pi from inside, under 0
/// from outside; at the sample, without the sample's triangle, half way between.
Facing facing_at(const Sample& sample, const TriangleMesh& mesh, const MeshSheet& sheet,
                 const Caps& caps) {
  double angle = 0.0;
  for (const std::size_t i : sheet.triangles) {
    if (i != sample.triangle) angle += solid_angle(corners_of(mesh, i), sample.point);
  }
  for (const auto& triangle : caps.triangles) angle += solid_angle(triangle, sample.point);
  constexpr double tolerance = 0.1;  // of roundings; other answers are 4 pi away
  if (std::abs(angle - 2.0 * std::numbers::pi) < tolerance) return Facing::outwards;
  if (std::abs(angle + 2.0 * std::numbers::pi) < tolerance) return Facing::inwards;
  return Facing::unknown;
}

Facing facing_of(const std::vector<Sample>& samples, const TriangleMesh& mesh,
                 const MeshSheet& sheet, const Caps& caps) {
  if (samples.empty() || samples.size() > most_samples) return Facing::unknown;
  const Facing facing = facing_at(samples.front(), mesh, sheet, caps);
  const bool same = std::all_of(samples.begin() + 1, samples.end(), [&](const Sample& sample) {
    return facing_at(sample, mesh, sheet, caps) == facing;
  });
  return same ? facing : Facing::unknown;
}

}  // namespace

std::vector<MeshSheet> mesh_sheets(const TriangleMesh& welded) {
  const std::size_t count = welded.triangles.size();
  EdgeUses edges = collect_edges(welded);
  DisjointSets sets(count);
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
  std::map<std::size_t, std::vector<RimEdge>> rims;  // by the sheets' first triangles
  for (const auto& [triangle, edge] : rim_runs) rims[sets.find(triangle)].push_back(edge);

  std::vector<MeshSheet> sheets;
  std::map<std::size_t, Caps> capped;  // by the sheets' numbers
  std::vector<bool> cut(count, false);
  for (std::vector<std::size_t>& triangles : sets.members()) {
    MeshSheet& sheet = sheets.emplace_back();
    sheet.triangles = std::move(triangles);
    const auto rim = rims.find(sheet.triangles.front());
    if (rim == rims.end()) {
      const Vector3d eye = corners_of(welded, sheet.triangles.front())[0];
      const double volume = signed_volume(welded, sheet.triangles, eye);
      sheet.facing = volume < 0.0 ? Facing::inwards : Facing::outwards;
    } else if (auto caps = make_caps(welded, sheet, rim->second)) {
      for (const std::size_t i : sheet.triangles) {
        cut[i] = may_meet(caps->balls, corners_of(welded, i));
      }
      capped.emplace(sheets.size() - 1, *std::move(caps));
    }
  }
  if (capped.empty()) return sheets;

  DisjointSets parts(count);
  for_each_edge(edges, [&](std::uint32_t /*lower*/, const EdgeUse* begin, const EdgeUse* end) {
    if (!is_regular(begin, end)) return;
    const std::uint32_t a = begin[0].triangle / 2;
    const std::uint32_t b = begin[1].triangle / 2;
    if (!cut[a] && !cut[b]) parts.join(a, b);
  });
  for (auto& [number, caps] : capped) {
    MeshSheet& sheet = sheets[number];
    const std::vector<Sample> samples = choose_samples(welded, sheet, caps, cut, parts);
    sheet.facing = facing_of(samples, welded, sheet, caps);
    if (sheet.facing != Facing::unknown) sheet.holes = std::move(caps.balls);
  }
  return sheets;
}

}  // namespace penumbra
