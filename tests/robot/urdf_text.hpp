// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/temporary_folder.hpp"
#include "../support/test.hpp"

#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

inline std::string robot_xml(const std::string& body, const std::string& name = "r") {
  return "<robot name=\"" + name + "\">\n" + body + "\n</robot>\n";
}

inline std::string link_xml(const std::string& name, const std::string& body = "") {
  return "<link name=\"" + name + "\">" + body + "</link>\n";
}

inline std::string joint_xml(const std::string& name, const std::string& type,
                             const std::string& parent, const std::string& child,
                             const std::string& body = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/>" + body + "</joint>\n";
}

inline std::string collision_xml(const std::string& shape, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + shape + "</geometry></collision>";
}

inline std::string visual_xml(const std::string& shape) {
  return "<visual><geometry>" + shape + "</geometry></visual>";
}

/// A collision box; `size`: three numbers.
inline std::string box_xml(const std::string& size) {
  return collision_xml("<box size=\"" + size + "\"/>");
}

inline Robot parse(const std::string& xml, const RobotOptions& options = {}) {
  return Robot::parse(xml, ".", options);
}

/// A chain of links l0, l1, ... with joints j0, j1, ... of every type; j2 and j5 float.
inline Robot every_kind() {
  std::string body = link_xml("l0");
  const char* types[] = {"revolute", "continuous", "floating", "prismatic",
                         "planar",   "floating",   "fixed"};
  for (std::size_t i = 0; i < std::size(types); ++i)
    body += link_xml("l" + std::to_string(i + 1)) +
            joint_xml("j" + std::to_string(i), types[i], "l" + std::to_string(i),
                      "l" + std::to_string(i + 1), "<axis xyz=\"0 0 1\"/>");
  return parse(robot_xml(body));
}

}  // namespace penumbra::test
