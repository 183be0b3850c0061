// SPDX-License-Identifier: Apache-2.0
// Broken files give an InputError or a robot: never a crash, a hang or another exception.
#include "../support/data.hpp"
#include "plain_robot.hpp"
#include "urdf_text.hpp"

namespace penumbra::test {
namespace {

// Every element and attribute that is read, and some that are not.
const std::string kEverything = robot_xml(
    "<material name=\"m\"><color rgba=\"1 0 0 1\"/></material><!-- note -->" +
    link_xml("a", "<inertial><mass value=\"1\"/></inertial>" +
                      collision_xml("<box size=\"1 2 3\"/>",
                                    "<origin xyz=\"1 0 -1e-3\" rpy=\"0 .5 0\"/>") +
                      visual_xml("<mesh filename=\"package://p/x.dae\" scale=\"1 -1 1\"/>")) +
    link_xml("b", collision_xml("<cylinder radius=\"0.1\" length=\"0.3\"/>") +
                      collision_xml("<capsule radius=\"0.1\" length=\"0.3\"/>")) +
    link_xml("c", collision_xml("<sphere radius=\"0.1\"/>", "<origin quat_xyzw=\"0 0 0 1\"/>")) +
    joint_xml("ab", "continuous", "a", "b", "<axis xyz=\"0 0 1\"/><dynamics damping=\"1\"/>") +
    joint_xml("bc", "revolute", "b", "c",
              "<limit lower=\"-1\" upper=\"1\"/><mimic joint=\"ab\" offset=\"1\"/>"));

// Whether it was read. Meshes are not at hand: only their absence may be forgiven.
bool survives(const std::string& xml) {
  return refusal([&] { (void)parse(xml, {.allow_missing_meshes = true}); }).empty();
}

std::string mutated(Random& random, std::string xml) {
  for (std::size_t n = 1 + below(random, 4); n > 0 && !xml.empty(); --n) {
    const std::size_t at = below(random, xml.size());
    const std::size_t length = 1 + below(random, 30);
    switch (below(random, 5)) {
      case 0:
        xml[at] = char(below(random, 256));
        break;
      case 1:
        xml.erase(at, length);
        break;
      case 2:
        xml.insert(at, xml.substr(below(random, xml.size()), length));
        break;
      case 3:
        xml[at] = "<>\"'/=&-.0123456789 \n"[below(random, 21)];
        break;
      default:
        std::swap(xml[at], xml[below(random, xml.size())]);
    }
  }
  return xml;
}

/// The text above and, where the data are, a real robot's.
std::vector<std::string> urdfs() {
  std::vector<std::string> all{kEverything};
  if (has_data()) all.push_back(read_bytes(data_folder() / "robots/ur5e/ur5e.urdf"));
  return all;
}

TEST(UrdfFuzz, TruncatedAnywhereIsAnError) {
  for (const std::string& xml : urdfs()) {
    const std::size_t end = xml.rfind("</robot>") + std::string("</robot>").size();
    for (std::size_t size = 0; size < end; ++size)
      ASSERT_FALSE(survives(xml.substr(0, size))) << "cut to " << size << " bytes it was read";
    EXPECT_TRUE(survives(xml.substr(0, end)));
  }
}

TEST(UrdfFuzz, MutatedFilesAreReadOrRefused) {
  Random random = seeded_random(8);
  for (const std::string& xml : urdfs()) {
    const int trials = xml != kEverything ? 1000 : is_full_run() ? 500000 : 5000;
    int read = 0;
    for (int trial = 0; trial < trials; ++trial) read += survives(mutated(random, xml)) ? 1 : 0;
    EXPECT_GT(read, 0);
    EXPECT_LT(read, trials);
  }
}

TEST(UrdfFuzz, DeepNestingIsRefused) {
  std::string xml = "<robot name=\"r\">";
  for (int i = 0; i < 100000; ++i) xml += "<gazebo>";
  EXPECT_FALSE(survives(xml));
}

}  // namespace
}  // namespace penumbra::test
