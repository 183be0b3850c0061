// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <penumbra/robot/robot.hpp>

namespace penumbra::detail {

// What a URDF file says, element by element, checked one by one but not yet against each other.
// Lengths in metres, angles in radians; `line` is where the element starts.

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
  double radius, length;  // of the cylindrical part
};
struct UrdfMesh {
  std::string filename;  // a path or URI as written
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// A visual or collision element.
struct UrdfElement {
  int line = 0;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  // T_link_shape
  std::variant<UrdfBox, UrdfCylinder, UrdfSphere, UrdfCapsule, UrdfMesh> shape;
  std::string fault;  // why it cannot be drawn, with its place in the file; empty: it can
};

struct UrdfLink {
  std::string name;
  int line = 0;
  std::vector<UrdfElement> visuals, collisions;

  [[nodiscard]] const std::vector<UrdfElement>& elements(Geometry g) const {
    return g == Geometry::visual ? visuals : collisions;
  }
};

/// A multiplier or an offset beyond it was written in another unit.
inline constexpr double kLargestMimic = 1e9;

struct UrdfMimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;
};

struct UrdfJoint {
  std::string name;
  int line = 0;
  JointType type = JointType::fixed;
  std::string parent, child;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // unit
  std::optional<double> velocity;
  std::optional<double> lower, upper;
  std::optional<UrdfMimic> mimic;
};

struct Urdf {
  std::string file;  // for messages
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<std::string> warnings;  // lines
};

/// Reads the text of a URDF. Throws InputError that names file, line and element; faults of visual
/// and collision elements are kept for those who draw them.
[[nodiscard]] Urdf read_urdf(std::string_view xml, const std::string& file);

}  // namespace penumbra::detail
