// SPDX-License-Identifier: Apache-2.0
// What a URDF may hold that Penumbra does not read.
#include "urdf_text.hpp"

#include <string>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

/// What no reader of URDFs knows is ignored, and said once for each kind.
TEST(UrdfFile, UnknownElementsAreWarnings) {
  const std::string traits = "<traits kind=\"x\"/>";
  const Robot robot = parse(
      robot_xml(link_xml("a", collision_xml("<sphere radius=\"1\" diameter=\"2\"/>") + traits) +
                link_xml("b", traits + ">") +
                joint_xml("j", "fixed", "a", "b", "<controller_gains/>") + "<frame name=\"f\"/>"));
  std::string all;
  for (const std::string& note : robot.notes()) all += note + '\n';
  EXPECT_EQ(robot.notes().size(), 5U) << all;
  for (const char* part :
       {":2: link \"a\": unknown element \"traits\"", "\"diameter\"", "text \">\"",
        ":4: joint \"j\": unknown element \"controller_gains\"", "\"frame\""})
    EXPECT_TRUE(holds(all, part));
}

/// A box of size 0 that is never drawn.
TEST(UrdfFile, GeometryThatIsNotDrawnIsNotChecked) {
  const std::string xml = robot_xml(
      link_xml("a", collision_xml("<sphere radius=\"1\"/>") + visual_xml("<box size=\"0 0 0\"/>")));
  EXPECT_EQ(parse(xml).links().size(), 1U);
  EXPECT_TRUE(holds(message_of([&] { (void)parse(xml, {.geometry = Geometry::visual}); }),
                    "link \"a\", visual, geometry, box"));
  RobotOptions options{.geometry = Geometry::visual};
  options.allow_missing_meshes = true;
  EXPECT_TRUE(holds(parse(xml, options).report()[0].fault, "size=\"0 0 0\""));
}

}  // namespace
}  // namespace penumbra::test
