// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "../support/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <penumbra/base/error.hpp>
#include <penumbra/robot/robot.hpp>

namespace penumbra::test {

inline std::string robot_xml(const std::string& body) {
  return "<robot name=\"r\">\n" + body + "\n</robot>\n";
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

inline std::string visual_xml(const std::string& shape, const std::string& origin = "") {
  return "<visual>" + origin + "<geometry>" + shape + "</geometry></visual>";
}

inline Robot parse(const std::string& xml, const RobotOptions& options = {}) {
  return Robot::parse(xml, ".", options);
}

/// The message of the InputError that f throws; a failure of the test if it throws none.
template <typename F>
std::string message_of(F&& f) {
  try {
    f();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

inline ::testing::AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << '"' << part << "\" is not in: " << text;
}

/// An ASCII STL of the tetrahedron (0,0,0), (size,0,0), (0,size,0), (0,0,size), wound outwards.
inline std::string tetrahedron_stl(double size = 1.0) {
  const std::string s = std::to_string(size);
  const std::string corners[4] = {"0 0 0", s + " 0 0", "0 " + s + " 0", "0 0 " + s};
  constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  std::string text = "solid t\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) text += "vertex " + corners[corner] + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid t\n";
}

}  // namespace penumbra::test
