// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

// A robot as plain numbers and its kinematics as products of 4x4 matrices, written apart from the
// library as its oracle.

using Matrix = Eigen::Matrix4d;

inline Matrix translation(const Vector3d& t) {
  Matrix m = Matrix::Identity();
  m.topRightCorner<3, 1>() = t;
  return m;
}

/// Rodrigues' formula: I + sin K + (1 - cos) K K with K the cross product by the axis.
inline Matrix rotation(const Vector3d& axis, double angle) {
  Matrix3d k;
  k << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  Matrix m = Matrix::Identity();
  m.topLeftCorner<3, 3>() += std::sin(angle) * k + (1.0 - std::cos(angle)) * k * k;
  return m;
}

inline Matrix quaternion(double x, double y, double z, double w) {
  const Vector3d axis(x, y, z);
  const double s = axis.norm();
  if (s == 0.0) return Matrix::Identity();
  return rotation(axis / s, 2.0 * std::atan2(s, w));
}

/// Turns about the fixed axes: first roll about x, then pitch about y, then yaw about z.
inline Matrix fixed_axes(const Vector3d& rpy) {
  return rotation(Vector3d::UnitZ(), rpy[2]) * rotation(Vector3d::UnitY(), rpy[1]) *
         rotation(Vector3d::UnitX(), rpy[0]);
}

struct PlainJoint {
  std::string name, type, parent, child;
  Matrix origin = Matrix::Identity();
  Vector3d xyz = Vector3d::Zero(), rpy = Vector3d::Zero();
  Vector3d axis = Vector3d::UnitX();  // of any length
  double lower = 0.0, upper = 0.0;
  std::string mimics;
  double multiplier = 1.0, offset = 0.0;
};

struct PlainRobot {
  std::vector<std::string> links;
  std::vector<PlainJoint> joints;
};

using Positions = std::map<std::string, double>;

inline double value_of(const PlainRobot& robot, const PlainJoint& joint, const Positions& at) {
  if (joint.mimics.empty()) return at.at(joint.name);
  for (const PlainJoint& other : robot.joints)
    if (other.name == joint.mimics)
      return joint.multiplier * value_of(robot, other, at) + joint.offset;
  throw std::logic_error("mimics nothing");
}

// x and y of the plane: the frame's axes turned from z (or -z) to the normal the shortest way.
inline Matrix planar_motion(const Vector3d& n, double x, double y, double yaw) {
  const bool below = n.z() < 0.0;
  const double sign = below ? -1.0 : 1.0;
  const double s = std::hypot(n.x(), n.y());
  Vector3d about = Vector3d::UnitX();
  if (s > 0.0) about << -sign * n.y() / s, sign * n.x() / s, 0.0;
  Matrix axes = rotation(about, std::atan2(s, sign * n.z()));
  if (below) axes *= rotation(Vector3d::UnitX(), std::numbers::pi);
  const Vector3d shift = axes.topLeftCorner<3, 2>() * Vector2d(x, y);
  return translation(shift) * rotation(n, yaw);
}

inline Matrix motion_of(const PlainRobot& robot, const PlainJoint& joint, const Positions& at) {
  if (joint.type == "fixed") return Matrix::Identity();
  const std::string& n = joint.name;
  if (joint.type == "floating")
    return translation({at.at(n + "/x"), at.at(n + "/y"), at.at(n + "/z")}) *
           quaternion(at.at(n + "/qx"), at.at(n + "/qy"), at.at(n + "/qz"), at.at(n + "/qw"));
  const Vector3d axis = joint.axis.normalized();
  if (joint.type == "planar")
    return planar_motion(axis, at.at(n + "/x"), at.at(n + "/y"), at.at(n + "/yaw"));
  const double q = value_of(robot, joint, at);
  if (joint.type == "prismatic") return translation(q * axis);
  return rotation(axis, q);
}

/// T_root_link.
inline Matrix pose_of(const PlainRobot& robot, const std::string& link, const Positions& at) {
  for (const PlainJoint& joint : robot.joints)
    if (joint.child == link)
      return pose_of(robot, joint.parent, at) * joint.origin * motion_of(robot, joint, at);
  return Matrix::Identity();
}

using Random = std::mt19937_64;

/// All digits of a double.
inline std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string exact(const Vector3d& t) {
  return exact(t[0]) + " " + exact(t[1]) + "  " + exact(t[2]);
}

inline bool has_one_value(const PlainJoint& joint) {
  return joint.type == "revolute" || joint.type == "continuous" || joint.type == "prismatic";
}

inline PlainJoint random_joint(Random& random, std::size_t child, const std::string& type) {
  PlainJoint joint;
  joint.name = "joint_" + std::to_string(child);
  joint.type = type;
  joint.parent = "link_" + std::to_string(below(random, child));
  joint.child = "link_" + std::to_string(child);
  joint.xyz = random_triple(random, 1.0);
  joint.rpy = random_triple(random, 4.0);
  joint.origin = translation(joint.xyz) * fixed_axes(joint.rpy);
  joint.axis = random_triple(random, 2.0);
  if (below(random, 3) == 0) joint.axis = {0, 0, below(random, 2) == 0 ? 1.0 : -1.0};
  joint.lower = uniform(random, -4.0, 0.0);
  joint.upper = uniform(random, 0.0, 4.0);
  return joint;
}

/// A tree of `links` links with every joint type of `types`; a third of the joints that can mimic
/// one with a lower number do (chains arise).
inline PlainRobot random_robot(Random& random, std::size_t links,
                               const std::vector<std::string>& types) {
  PlainRobot robot;
  for (std::size_t i = 0; i < links; ++i) robot.links.push_back("link_" + std::to_string(i));
  for (std::size_t i = 1; i < links; ++i) {
    PlainJoint joint = random_joint(random, i, types[below(random, types.size())]);
    const auto target = std::find_if(robot.joints.begin(), robot.joints.end(), has_one_value);
    if (has_one_value(joint) && target != robot.joints.end() && below(random, 3) == 0) {
      std::vector<std::string> names;
      for (const PlainJoint& j : robot.joints)
        if (has_one_value(j)) names.push_back(j.name);
      joint.mimics = names[below(random, names.size())];
      joint.multiplier = uniform(random, -2.0, 2.0);
      joint.offset = uniform(random, -1.0, 1.0);
    }
    robot.joints.push_back(joint);
  }
  return robot;
}

inline std::string joint_text(const PlainJoint& joint) {
  std::string text = "<joint name=\"" + joint.name + "\" type=\"" + joint.type + "\">" +
                     "<origin xyz=\"" + exact(joint.xyz) + "\" rpy=\"" + exact(joint.rpy) + "\"/>" +
                     "<parent link=\"" + joint.parent + "\"/><child link=\"" + joint.child + "\"/>";
  if (joint.type != "fixed" && joint.type != "floating")
    text += "<axis xyz=\"" + exact(joint.axis) + "\"/>";
  if (joint.type == "revolute" || joint.type == "prismatic")
    text += "<limit effort=\"1\" velocity=\"1\" lower=\"" + exact(joint.lower) + "\" upper=\"" +
            exact(joint.upper) + "\"/>";
  if (!joint.mimics.empty())
    text += "<mimic joint=\"" + joint.mimics + "\" multiplier=\"" + exact(joint.multiplier) +
            "\" offset=\"" + exact(joint.offset) + "\"/>";
  return text + "</joint>\n";
}

/// The URDF of a robot, its elements in random order.
inline std::string urdf_text(Random& random, const PlainRobot& robot) {
  std::vector<std::string> elements;
  for (const std::string& link : robot.links) elements.push_back("<link name=\"" + link + "\"/>\n");
  for (const PlainJoint& joint : robot.joints) elements.push_back(joint_text(joint));
  std::shuffle(elements.begin(), elements.end(), random);
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"random\">\n";
  for (const std::string& element : elements) text += element;
  return text + "</robot>\n";
}

// Chains of some tens of links of a metre, each rotation rounded to 1e-16.
constexpr double kPoseTolerance = 1e-12;

inline void expect_pose(const Isometry3d& pose, const Matrix& expected, const std::string& link) {
  EXPECT_LT((pose.matrix() - expected).cwiseAbs().maxCoeff(), kPoseTolerance) << link;
}

/// Poses every link at random positions and compares with the plain matrices.
inline void expect_kinematics(Random& random, const Robot& robot, const PlainRobot& plain) {
  std::vector<double> positions;
  Positions by_name;
  for (const std::string& name : robot.variables())
    positions.push_back(by_name[name] = uniform(random, -3.0, 3.0));
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    expect_pose(poses[i], pose_of(plain, robot.links()[i], by_name), robot.links()[i]);
}

}  // namespace penumbra::test
