// SPDX-License-Identifier: Apache-2.0
#include "shapes.hpp"

#include <cmath>

namespace penumbra::test {

using Eigen::Vector3d;
using Eigen::Vector3f;

TriangleMesh triangle(const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

TriangleMesh quad(const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& d) {
  return {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh image_rectangle(const Intrinsics& intrinsics, double u0, double v0, double u1,
                             double v1, double z) {
  const auto corner = [&](double u, double v) -> Vector3f {
    return (intrinsics.ray(u, v) * z).cast<float>();
  };
  return quad(corner(u0, v0), corner(u0, v1), corner(u1, v1), corner(u1, v0));
}

TriangleMesh box(const Vector3f& half_size) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    const Vector3f signs((i & 1U) != 0 ? 1.0F : -1.0F, (i & 2U) != 0 ? 1.0F : -1.0F,
                         (i & 4U) != 0 ? 1.0F : -1.0F);
    mesh.vertices.emplace_back(signs.cwiseProduct(half_size));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh sphere(float radius, int rings) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = M_PI * i / rings, azimuth = M_PI * j / rings;
      const Vector3d unit(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                          std::cos(polar));
      mesh.vertices.emplace_back(unit.cast<float>() * radius);
    }
  const auto at_ring = [&](int i, int j) { return std::uint32_t((i - 1) * around + j % around); };
  const auto north = std::uint32_t(mesh.vertices.size());
  const auto south = north + 1;
  mesh.vertices.emplace_back(0.0F, 0.0F, radius);
  mesh.vertices.emplace_back(0.0F, 0.0F, -radius);
  for (int j = 0; j < around; ++j) {
    mesh.triangles.push_back({north, at_ring(1, j), at_ring(1, j + 1)});
    mesh.triangles.push_back({south, at_ring(rings - 1, j + 1), at_ring(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at_ring(i, j), at_ring(i + 1, j), at_ring(i + 1, j + 1)});
      mesh.triangles.push_back({at_ring(i, j), at_ring(i + 1, j + 1), at_ring(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh torus(std::uint32_t rows, std::uint32_t columns, double ring, double tube) {
  TriangleMesh mesh;
  const auto index = [&](std::uint32_t i, std::uint32_t j) {
    return (i % rows) * columns + j % columns;
  };
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double a = 2 * M_PI * i / rows, b = 2 * M_PI * j / columns;
      const double r = ring + tube * std::cos(b);
      mesh.vertices.push_back(
          Vector3d(r * std::cos(a), r * std::sin(a), tube * std::sin(b)).cast<float>());
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  return mesh;
}

TriangleMesh revolved(const std::vector<Eigen::Vector2f>& profile, std::uint32_t around) {
  TriangleMesh mesh;
  for (const Eigen::Vector2f& p : profile)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * M_PI * i / around;
      mesh.vertices.emplace_back(p.x() * float(std::cos(a)), p.x() * float(std::sin(a)), p.y());
    }
  for (std::uint32_t row = 0; row + 1 < profile.size(); ++row)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = row * around + i;
      const std::uint32_t b = row * around + (i + 1) % around;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = std::uint32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles)
    mesh.triangles.push_back({a + first, b + first, c + first});
}

TriangleMesh mirrored(TriangleMesh mesh) {
  for (Vector3f& vertex : mesh.vertices) vertex.x() = -vertex.x();
  return mesh;
}

TriangleMesh triangle_soup(std::mt19937_64& random, int count, float extent) {
  std::uniform_real_distribution<float> coordinate(-extent, extent);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto first = std::uint32_t(mesh.vertices.size());
    for (int j = 0; j < 3; ++j) {
      const float x = coordinate(random), y = coordinate(random);
      mesh.vertices.emplace_back(x, y, coordinate(random));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Eigen::Isometry3d random_pose(std::mt19937_64& random, const Vector3d& low_corner,
                              const Vector3d& high_corner) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double w = normal(random), x = normal(random), y = normal(random);
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(w, x, y, normal(random)).normalized();
  Vector3d position;
  for (int i = 0; i < 3; ++i)
    position[i] = low_corner[i] + unit(random) * (high_corner[i] - low_corner[i]);
  return Eigen::Translation3d(position) * rotation;
}

Eigen::Quaterniond turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d axis = from.cross(to);
  const double angle = std::atan2(axis.norm(), from.dot(to));
  const bool parallel = axis.norm() <= 1e-12 * from.norm() * to.norm();
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(angle, parallel ? from.unitOrthogonal() : axis.normalized()));
}

}  // namespace penumbra::test
