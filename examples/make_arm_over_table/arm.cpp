// SPDX-License-Identifier: Apache-2.0
#include "arm.hpp"

#include <map>
#include <numbers>

namespace example {
namespace {

constexpr double quarter = std::numbers::pi / 2.0;
const Vector3d lying_along_y(-quarter, 0.0, 0.0);  // rpy that turns z to y

Shape traced(Mesh mesh) { return std::make_shared<const TracedMesh>(std::move(mesh)); }

Mesh base_mesh() {
  return turned({{0.100, 0.000},
                 {0.105, 0.004},
                 {0.105, 0.020},
                 {0.100, 0.025},
                 {0.080, 0.030},
                 {0.076, 0.040},
                 {0.074, 0.105},
                 {0.070, 0.112},
                 {0.066, 0.114}},
                48);
}

Mesh shoulder_mesh() {
  return lofted({{0.002, 0.070, 0.070},
                 {0.008, 0.074, 0.074},
                 {0.050, 0.072, 0.070},
                 {0.090, 0.064, 0.060},
                 {0.130, 0.056, 0.050},
                 {0.148, 0.044, 0.040},
                 {0.152, 0.034, 0.030}},
                3.0, 40);
}

Mesh upper_arm_mesh() {
  return lofted({{-0.030, 0.020, 0.020, 0.0, 0.115},
                 {0.000, 0.048, 0.042, 0.0, 0.115},
                 {0.080, 0.047, 0.042, 0.0, 0.115},
                 {0.190, 0.039, 0.037, 0.0, 0.112},
                 {0.300, 0.040, 0.038, 0.0, 0.112},
                 {0.380, 0.042, 0.038, 0.0, 0.115},
                 {0.410, 0.018, 0.018, 0.0, 0.115}},
                2.8, 36);
}

Mesh forearm_mesh() {
  return lofted({{-0.020, 0.015, 0.015, 0.0, 0.015},
                 {0.000, 0.038, 0.034, 0.0, 0.015},
                 {0.060, 0.039, 0.035, 0.0, 0.012},
                 {0.180, 0.033, 0.031, 0.0, 0.010},
                 {0.300, 0.030, 0.029, 0.0, 0.010},
                 {0.330, 0.028, 0.027, 0.0, 0.010},
                 {0.345, 0.012, 0.012, 0.0, 0.010}},
                2.4, 36);
}

Mesh flange_mesh() {
  return turned({{0.030, 0.000},
                 {0.034, 0.004},
                 {0.034, 0.050},
                 {0.031, 0.056},
                 {0.031, 0.064},
                 {0.026, 0.066},
                 {0.026, 0.072}},
                36);
}

Mesh palm_mesh() {
  return lofted({{0.000, 0.026, 0.026},
                 {0.010, 0.030, 0.034},
                 {0.020, 0.030, 0.050},
                 {0.052, 0.028, 0.052},
                 {0.058, 0.025, 0.049}},
                5.0, 40);
}

/// The left finger: closes towards -y.
Mesh finger_mesh() {
  return lofted({{0.000, 0.012, 0.008, 0.0, 0.008},
                 {0.015, 0.012, 0.008, 0.0, 0.008},
                 {0.040, 0.011, 0.006, 0.0, 0.006},
                 {0.068, 0.010, 0.004, 0.0, 0.004},
                 {0.072, 0.007, 0.002, 0.0, 0.003}},
                6.0, 24);
}

Mesh mirrored_in_y(Mesh mesh) {
  for (auto& v : mesh.vertices) v.y() = -v.y();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

std::vector<ArmJoint> make_joints() {
  const Vector3d y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  return {{"shoulder_pan", "revolute", "base_link", "shoulder", {{0, 0, 0.114}, {0, 0, 0}}, z, 0},
          {"shoulder_lift", "revolute", "shoulder", "upper_arm", {{0, 0, 0.095}, {0, 0, 0}}, y, 1},
          {"elbow", "revolute", "upper_arm", "forearm", {{0, 0, 0.380}, {0, 0, 0}}, y, 2},
          {"wrist_1", "revolute", "forearm", "wrist_1_link", {{0, 0.010, 0.330}, {0, 0, 0}}, y, 3},
          {"wrist_2", "revolute", "wrist_1_link", "wrist_2_link", {{0, 0.090, 0}, {0, 0, 0}}, z, 4},
          {"wrist_3", "continuous", "wrist_2_link", "flange", {{0, 0, 0.085}, {0, 0, 0}}, y, 5},
          {"tool_mount", "fixed", "flange", "gripper", {{0, 0.072, 0}, lying_along_y}, z},
          {"gripper_left", "prismatic", "gripper", "finger_left", {{0, 0, 0.058}, {0, 0, 0}}, y, 6},
          {"gripper_right",
           "prismatic",
           "gripper",
           "finger_right",
           {{0, 0, 0.058}, {0, 0, 0}},
           -y,
           6,
           true},
          {"tool_point", "fixed", "gripper", "tool0", {{0, 0, 0.120}, {0, 0, 0}}, z}};
}

Origin lying(double y, double z = 0.0) { return {{0.0, y, z}, lying_along_y}; }

std::vector<Part> make_parts() {
  const Vector3d millimetres = Vector3d::Constant(0.001);
  const Mesh finger = finger_mesh();
  return {{"base_link", traced(base_mesh()), {}, "graphite", "base.stl"},
          {"shoulder", traced(shoulder_mesh()), {}, "white", "shoulder.obj"},
          {"shoulder", Cylinder{0.060, 0.126}, lying(0.001, 0.095), "white"},
          {"shoulder", Cylinder{0.050, 0.012}, lying(-0.066, 0.095), "blue"},
          {"upper_arm", traced(upper_arm_mesh()), {}, "white", "upper_arm.dae"},
          {"upper_arm", Cylinder{0.060, 0.094}, lying(0.115), "white"},
          {"upper_arm", Cylinder{0.050, 0.012}, lying(0.166), "blue"},
          {"upper_arm", Cylinder{0.050, 0.086}, lying(0.115, 0.380), "white"},
          {"upper_arm", Cylinder{0.042, 0.012}, lying(0.162, 0.380), "blue"},
          {"forearm", traced(forearm_mesh()), {}, "white", "forearm.stl", millimetres},
          {"forearm", Cylinder{0.050, 0.102}, lying(0.017), "white"},
          {"forearm", Cylinder{0.042, 0.010}, lying(-0.038), "blue"},
          {"forearm", Cylinder{0.033, 0.076}, lying(0.010, 0.330), "graphite"},
          {"wrist_1_link", Cylinder{0.033, 0.048}, lying(0.066), "white"},
          {"wrist_1_link", Sphere{0.036}, {{0, 0.090, 0}, {0, 0, 0}}, "white"},
          {"wrist_2_link", Cylinder{0.032, 0.066}, {{0, 0, 0.052}, {0, 0, 0}}, "graphite"},
          {"wrist_2_link", Sphere{0.036}, {{0, 0, 0.085}, {0, 0, 0}}, "white"},
          {"flange", traced(flange_mesh()), lying(0.0), "white", "flange.stl"},
          {"gripper", traced(palm_mesh()), {}, "graphite", "palm.obj"},
          {"gripper", Box{{0.040, 0.008, 0.030}}, {{0, 0.052, 0.035}, {0, 0, 0}}, "blue"},
          {"finger_left", traced(finger), {}, "steel", "finger.stl", millimetres},
          {"finger_right",
           traced(mirrored_in_y(finger)),
           {},
           "steel",
           "finger.stl",
           {0.001, -0.001, 0.001}}};
}

}  // namespace

Isometry3d Origin::transform() const {
  Isometry3d T = Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
                Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
                Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() = xyz;
  return T;
}

Vector3d Part::colour() const {
  static const std::map<std::string, Vector3d> colours{{"white", {0.86, 0.87, 0.88}},
                                                       {"blue", {0.13, 0.38, 0.66}},
                                                       {"graphite", {0.24, 0.25, 0.28}},
                                                       {"steel", {0.58, 0.60, 0.62}}};
  return colours.at(material);
}

const std::array<std::string, Arm::value_count>& Arm::value_names() {
  static const std::array<std::string, value_count> names{
      "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3", "gripper_left"};
  return names;
}

Arm::Arm() : joints_(make_joints()), parts_(make_parts()) {}

Isometry3d Arm::link_pose(const std::string& link, const Values& values) const {
  for (const auto& joint : joints_) {
    if (joint.child != link) continue;
    Isometry3d motion = Isometry3d::Identity();
    if (joint.value >= 0) {
      const double q = values[static_cast<std::size_t>(joint.value)];
      if (joint.type == "prismatic") {
        motion.translation() = q * joint.axis;
      } else {
        motion.linear() = Eigen::AngleAxisd(q, joint.axis).toRotationMatrix();
      }
    }
    return link_pose(joint.parent, values) * joint.origin.transform() * motion;
  }
  return Isometry3d::Identity();
}

std::vector<Isometry3d> Arm::part_poses(const Values& values) const {
  std::vector<Isometry3d> poses;
  for (const auto& part : parts_)
    poses.push_back(link_pose(part.link, values) * part.origin.transform());
  return poses;
}

}  // namespace example
