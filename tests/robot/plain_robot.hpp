// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/test.hpp"

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

// A robot as plain numbers and its kinematics as plain 4x4 matrices, written apart from the library
// as its oracle.

using Matrix = std::array<std::array<double, 4>, 4>;
using Triple = std::array<double, 3>;

inline Matrix identity() { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}; }

inline Matrix times(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

inline Matrix translation(const Triple& t) {
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i) m[i][3] = t[i];
  return m;
}

/// Rodrigues' formula: I + sin K + (1 - cos) K K with K the cross product by the axis.
inline Matrix rotation(const Triple& axis, double angle) {
  const auto [x, y, z] = axis;
  const Matrix k{{{0, -z, y, 0}, {z, 0, -x, 0}, {-y, x, 0, 0}, {0, 0, 0, 0}}};
  const Matrix kk = times(k, k);
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      m[i][j] += std::sin(angle) * k[i][j] + (1.0 - std::cos(angle)) * kk[i][j];
  return m;
}

inline Matrix quaternion(double x, double y, double z, double w) {
  const double n = std::sqrt(x * x + y * y + z * z + w * w);
  if (n == 0.0) return identity();
  const double s = std::sqrt(x * x + y * y + z * z);
  if (s == 0.0) return identity();
  return rotation({x / s, y / s, z / s}, 2.0 * std::atan2(s, w));
}

/// Turns about the fixed axes: first roll about x, then pitch about y, then yaw about z.
inline Matrix fixed_axes(const Triple& rpy) {
  return times(rotation({0, 0, 1}, rpy[2]),
               times(rotation({0, 1, 0}, rpy[1]), rotation({1, 0, 0}, rpy[0])));
}

struct PlainJoint {
  std::string name, type, parent, child;
  Matrix origin = identity();
  Triple xyz{}, rpy{};
  Triple axis{1, 0, 0};  // of any length
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

inline Triple unit(Triple a) {
  const double n = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  return {a[0] / n, a[1] / n, a[2] / n};
}

// x and y of the plane: the frame's axes turned from z (or -z) to the normal the shortest way.
inline Matrix planar_motion(const Triple& n, double x, double y, double yaw) {
  const bool below = n[2] < 0.0;
  const double sign = below ? -1.0 : 1.0;
  const double s = std::hypot(n[0], n[1]);
  const Triple about = s > 0.0 ? Triple{-sign * n[1] / s, sign * n[0] / s, 0.0} : Triple{1, 0, 0};
  const Matrix tilt = rotation(about, std::atan2(s, sign * n[2]));
  const Matrix flip = below ? rotation({1, 0, 0}, 3.14159265358979323846) : identity();
  const Matrix axes = times(tilt, flip);
  Triple shift{};
  for (std::size_t i = 0; i < 3; ++i) shift[i] = axes[i][0] * x + axes[i][1] * y;
  return times(translation(shift), rotation(n, yaw));
}

inline Matrix motion_of(const PlainRobot& robot, const PlainJoint& joint, const Positions& at) {
  if (joint.type == "fixed") return identity();
  const std::string& n = joint.name;
  if (joint.type == "floating")
    return times(
        translation({at.at(n + "/x"), at.at(n + "/y"), at.at(n + "/z")}),
        quaternion(at.at(n + "/qx"), at.at(n + "/qy"), at.at(n + "/qz"), at.at(n + "/qw")));
  const Triple axis = unit(joint.axis);
  if (joint.type == "planar")
    return planar_motion(axis, at.at(n + "/x"), at.at(n + "/y"), at.at(n + "/yaw"));
  const double q = value_of(robot, joint, at);
  if (joint.type == "prismatic") return translation({axis[0] * q, axis[1] * q, axis[2] * q});
  return rotation(axis, q);
}

/// T_root_link.
inline Matrix pose_of(const PlainRobot& robot, const std::string& link, const Positions& at) {
  for (const PlainJoint& joint : robot.joints)
    if (joint.child == link)
      return times(pose_of(robot, joint.parent, at),
                   times(joint.origin, motion_of(robot, joint, at)));
  return identity();
}

using Random = std::mt19937_64;

/// All digits of a double.
inline std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string exact(const Triple& t) {
  return exact(t[0]) + " " + exact(t[1]) + "  " + exact(t[2]);
}

inline Triple random_triple(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
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
  joint.origin = times(translation(joint.xyz), fixed_axes(joint.rpy));
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

inline std::vector<double> random_positions(Random& random, const Robot& robot) {
  std::vector<double> positions(robot.variables().size());
  for (double& value : positions) value = uniform(random, -3.0, 3.0);
  return positions;
}

inline void expect_pose(const Isometry3d& pose, const Matrix& expected, const std::string& link) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      EXPECT_NEAR(pose.matrix()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                  expected[i][j], kPoseTolerance)
          << link << " row " << i << " column " << j;
}

/// Poses every link at random positions and compares with the plain matrices.
inline void expect_kinematics(Random& random, const Robot& robot, const PlainRobot& plain) {
  const auto positions = random_positions(random, robot);
  Positions by_name;
  for (std::size_t i = 0; i < positions.size(); ++i) by_name[robot.variables()[i]] = positions[i];
  std::vector<Isometry3d> poses(robot.links().size());
  robot.forward_kinematics(positions, poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    expect_pose(poses[i], pose_of(plain, robot.links()[i], by_name), robot.links()[i]);
}

}  // namespace penumbra::test
