// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/base/xml_document-inl.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::detail {

// The elements of a URDF file. Each is valid by itself; build_tree() checks that they fit together.
// Lengths in metres, angles in radians. `place` names file, line and element, for messages.

struct UrdfBox {
  Eigen::Vector3d size;
};
struct UrdfCylinder {
  double radius, length;
};
struct UrdfSphere {
  double radius;
};
struct UrdfCapsule {
  double radius, length;  // length of the cylindrical part
};
struct UrdfEllipsoid {
  Eigen::Vector3d radii;
};
struct UrdfMesh {
  std::string filename;  // a path or URI as written
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Isometry3d T_scaled_file = Eigen::Isometry3d::Identity();  // before the scale
};

/// A visual or collision element.
struct UrdfElement {
  std::string place;                                         // that of its link
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  // T_link_shape
  std::variant<UrdfBox, UrdfCylinder, UrdfSphere, UrdfCapsule, UrdfEllipsoid, UrdfMesh> shape;
  std::string fault;  // why it cannot be drawn, with its place; empty if it can
};

struct UrdfLink {
  std::string name;
  std::string place;
  std::vector<UrdfElement> visuals, collisions;

  [[nodiscard]] const std::vector<UrdfElement>& elements(Geometry g) const {
    return g == Geometry::visual ? visuals : collisions;
  }
};

// Larger values were written in another unit. The radius also bounds the triangles of a sphere.
inline constexpr double largest_size = 1000.0;  // metres
inline constexpr double largest_radius = 50.0;  // metres
inline constexpr double farthest_origin = 1e6;  // metres

/// Metres: robots whose parts are larger or farther apart are rare, and those in millimetres have
/// larger numbers.
inline constexpr double likely_millimetres = 20.0;

/// Larger multipliers and offsets are an error of the unit.
inline constexpr double largest_mimic = 1e9;

struct UrdfMimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
};

struct UrdfJoint {
  std::string name;
  std::string place;
  Joint joint;  // links and variables are not set yet
  std::string parent, child;
  std::optional<UrdfMimic> mimic;
};

struct Urdf {
  std::string file;  // for messages
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<std::string> warnings;  // one line each
};

/// Reads a URDF. Throws InputError that names file, line and element; faults of visual and
/// collision elements are stored in the element instead.
[[nodiscard]] Urdf read_urdf(const XmlElement& root);

}  // namespace penumbra::detail
