// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <tests/robot/urdf_text.hpp>

#include <penumbra/base/mesh_topology.hpp>
#include <penumbra/base/triangle_mesh.hpp>
#include <penumbra/robot/primitives.hpp>
#include <penumbra/robot/surface_offset.hpp>

namespace penumbra::test {

/// Of float corners of models below 2 m: metres, m^3 of volumes, and shares of margins.
inline constexpr double corner_rounding = 1e-6;

/// Of all pieces, m^3.
inline double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const MeshComponent& piece : connected_components(weld(mesh))) sum += piece.signed_volume;
  return sum;
}

/// What offset_surface() says where it refuses a mesh.
inline std::string refusal(const TriangleMesh& mesh, double margin) {
  return message_of([&] { (void)offset_surface(mesh, margin); });
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other, const Eigen::Vector3d& shift) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& v : other.vertices) mesh.vertices.push_back(v + shift.cast<float>());
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// A polygon in x, y (counter-clockwise, star-shaped about its first corner), extruded to height.
inline TriangleMesh extrude(const std::vector<Eigen::Vector2d>& polygon, double height) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(polygon.size());
  for (const double z : {0.0, height})
    for (const auto& p : polygon)
      mesh.vertices.push_back(Eigen::Vector3d(p.x(), p.y(), z).cast<float>());
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

/// A sphere whose vertices are moved in and out at random: sharp, convex and concave everywhere.
inline TriangleMesh crumpled(std::mt19937_64& random, double amount) {
  TriangleMesh mesh = make_sphere(0.003);
  std::uniform_real_distribution<float> stretch(static_cast<float>(1 - amount), 1.0F);
  for (auto& v : mesh.vertices) v *= 30.0F * stretch(random);
  return mesh;
}

}  // namespace penumbra::test
