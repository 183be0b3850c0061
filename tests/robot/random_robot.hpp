// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plain_robot.hpp"

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace penumbra::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline std::size_t below(Random& random, std::size_t end) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

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

}  // namespace penumbra::test
