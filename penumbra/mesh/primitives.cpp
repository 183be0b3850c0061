// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>

#include <penumbra/base/error.hpp>
#include <penumbra/mesh/primitives.hpp>

namespace penumbra {
namespace {

constexpr double pi = std::numbers::pi;
// Metres; more triangles than these would need too much memory.
constexpr double largest_size = 1e6;
constexpr double largest_sphere = 100.0;      // 6 million triangles
constexpr double largest_cylinder = 10000.0;  // 33 thousand segments

void check_size(const char* what, double size, double largest = largest_size) {
  if (size > 0.0 && size <= largest) return;
  throw InputError(std::string(what) + " is " + std::to_string(size) +
                   "; expected metres above 0 and at most " + std::to_string(largest));
}

/// The polygon of a round primitive, midway between inscribed and circumscribed.
struct Rounding {
  std::uint32_t segments;  // around the axis, a multiple of 4
  double radius;           // of the corners
};

/// With corners at radius R, the faces of a cylinder (`power` 1) are c R = cos(pi/n) R from the
/// axis. For a sphere of equal steps in longitude and latitude (`power` 2), the largest face, at
/// the equator, is c R = cos(pi/n)^2 R from the centre. R - r = r - c R = error gives c and R.
Rounding round(double radius, int power) {
  const double c = (radius - primitive_error) / (radius + primitive_error);
  std::uint32_t segments = 8;
  if (c > 0.0) {
    const double step = std::acos(power == 1 ? c : std::sqrt(c));
    segments = std::max(segments, 4 * static_cast<std::uint32_t>(std::ceil(pi / step / 4.0)));
  }
  return {segments, 2.0 * radius / (1.0 + std::pow(std::cos(pi / segments), power))};
}

Eigen::Vector3f vertex(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).cast<float>();
}

/// A surface of revolution about z, built ring by ring from below.
class Lathe {
 public:
  explicit Lathe(std::uint32_t segments) : segments_(segments) {}

  void start(double z) { mesh_.vertices.push_back(vertex(0.0, 0.0, z)); }

  void add_ring(double radius, double z) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::uint32_t i = 0; i < segments_; ++i) {
      const double angle = 2.0 * pi * i / segments_;
      mesh_.vertices.push_back(vertex(radius * std::cos(angle), radius * std::sin(angle), z));
    }
    for (std::uint32_t i = 0; i < segments_; ++i) {
      const std::uint32_t next = (i + 1) % segments_;
      if (first == 1) {
        mesh_.triangles.push_back({0, first + next, first + i});
        continue;
      }
      const std::uint32_t below = first - segments_;
      mesh_.triangles.push_back({below + i, below + next, first + next});
      mesh_.triangles.push_back({below + i, first + next, first + i});
    }
  }

  TriangleMesh finish(double z) {
    const auto top = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(vertex(0.0, 0.0, z));
    for (std::uint32_t i = 0; i < segments_; ++i)
      mesh_.triangles.push_back({top - segments_ + i, top - segments_ + (i + 1) % segments_, top});
    return std::move(mesh_);
  }

 private:
  std::uint32_t segments_;
  TriangleMesh mesh_;
};

TriangleMesh round_body(double radius, double length) {
  const Rounding rounding = round(radius, 2);
  const std::uint32_t steps = rounding.segments / 4;  // from pole to equator
  const double half = length / 2.0;
  Lathe lathe(rounding.segments);
  lathe.start(-half - rounding.radius);
  for (std::uint32_t i = 1; i < 2 * steps; ++i) {
    const double latitude = pi / 2.0 * (static_cast<double>(i) / steps - 1.0);
    const double z = rounding.radius * std::sin(latitude);
    lathe.add_ring(rounding.radius * std::cos(latitude), i <= steps ? z - half : z + half);
    if (i == steps && length > 0.0) lathe.add_ring(rounding.radius, half);
  }
  return lathe.finish(half + rounding.radius);
}

}  // namespace

TriangleMesh make_box(const Eigen::Vector3d& size) {
  check_size("a box's size in x", size.x());
  check_size("a box's size in y", size.y());
  check_size("a box's size in z", size.z());
  TriangleMesh box;
  for (int i = 0; i < 8; ++i)
    box.vertices.push_back(vertex(size.x() * ((i & 1) - 0.5), size.y() * ((i >> 1 & 1) - 0.5),
                                  size.z() * ((i >> 2) - 0.5)));
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

TriangleMesh make_cylinder(double radius, double length) {
  check_size("a cylinder's radius", radius, largest_cylinder);
  check_size("a cylinder's length", length);
  const Rounding rounding = round(radius, 1);
  Lathe lathe(rounding.segments);
  lathe.start(-length / 2.0);
  lathe.add_ring(rounding.radius, -length / 2.0);
  lathe.add_ring(rounding.radius, length / 2.0);
  return lathe.finish(length / 2.0);
}

TriangleMesh make_sphere(double radius) {
  check_size("a sphere's radius", radius, largest_sphere);
  return round_body(radius, 0.0);
}

TriangleMesh make_capsule(double radius, double length) {
  check_size("a capsule's radius", radius, largest_sphere);
  if (length != 0.0) check_size("a capsule's length", length);
  return round_body(radius, length);
}

}  // namespace penumbra
