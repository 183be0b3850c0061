// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

namespace example {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Sphere {
  double radius;
};
/// Along z, centred, flat ends.
struct Cylinder {
  double radius, length;
};
/// Along z, centred; `length` without the round ends.
struct Capsule {
  double radius, length;
};
struct Box {
  Vector3d size;
};

/// Triangles wound outwards.
struct Mesh {
  std::vector<Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A mesh cut into runs of neighbouring triangles with a box around each, so that rays skip most.
class TracedMesh {
 public:
  explicit TracedMesh(Mesh mesh);
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }

  struct Run {
    std::size_t begin, end;
    Eigen::AlignedBox3d bounds;
  };
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }

 private:
  Mesh mesh_;
  std::vector<Run> runs_;
};

using Shape = std::variant<Sphere, Cylinder, Capsule, Box, std::shared_ptr<const TracedMesh>>;

struct Ray {
  Vector3d origin, direction;  ///< the direction may have any length
};

struct Hit {
  double t;         ///< in lengths of the ray's direction
  Vector3d normal;  ///< outwards; of any length
};

/// The first crossing of the surface at t > 0, in the shape's frame: closed forms and, for meshes,
/// every triangle of every run that the ray's line meets.
[[nodiscard]] std::optional<Hit> intersect(const Shape& shape, const Ray& ray);

[[nodiscard]] Eigen::AlignedBox3d bounds(const Shape& shape);

/// Whether the ray's line meets the box.
[[nodiscard]] bool meets(const Eigen::AlignedBox3d& box, const Ray& ray);

/// Turns a profile of (radius, z), from its lowest to its highest point on the axis, about z.
[[nodiscard]] Mesh turned(const std::vector<Vector2d>& profile, int segments);

/// A cross section at height z: half widths of a superellipse about (x, y).
struct Section {
  double z, half_x, half_y, x = 0.0, y = 0.0;
};

/// Skin over sections from bottom to top; `exponent` 2 gives ellipses, more gives rounded boxes.
[[nodiscard]] Mesh lofted(const std::vector<Section>& sections, double exponent, int segments);

/// Moved by T.
[[nodiscard]] Mesh moved(const Mesh& mesh, const Isometry3d& T);

}  // namespace example
