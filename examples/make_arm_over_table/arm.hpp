// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace example {

/// A URDF origin: metres, and roll, pitch, yaw in radians.
struct Origin {
  Vector3d xyz = Vector3d::Zero();
  Vector3d rpy = Vector3d::Zero();
  [[nodiscard]] Isometry3d transform() const;
};

struct ArmJoint {
  std::string name, type, parent, child;
  Origin origin;
  Vector3d axis = Vector3d::UnitZ();
  int value = -1;  ///< which of the arm's values moves it; -1: fixed
  bool mimics = false;
};

/// One visual and collision element. Meshes stand in a file; what is traced is the same surface.
struct Part {
  std::string link;
  Shape shape;
  Origin origin;
  std::string material;
  std::string file{};                 ///< of a mesh, in the folder meshes/
  Vector3d scale = Vector3d::Ones();  ///< as the URDF has it
  [[nodiscard]] Vector3d colour() const;
};

/// A six-axis arm with a two-finger gripper: our own drawing, of no real product.
class Arm {
 public:
  static constexpr int value_count = 7;
  using Values = std::array<double, value_count>;  ///< six angles, then the gripper's metres
  static const std::array<std::string, value_count>& value_names();

  Arm();
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

  /// Poses of the parts in the base frame, in the order of parts().
  [[nodiscard]] std::vector<Isometry3d> part_poses(const Values& values) const;

  /// Writes arm.urdf and meshes/.
  void write(const std::filesystem::path& folder) const;

 private:
  [[nodiscard]] Isometry3d link_pose(const std::string& link, const Values& values) const;
  [[nodiscard]] std::string urdf() const;

  std::vector<ArmJoint> joints_;
  std::vector<Part> parts_;
};

}  // namespace example
