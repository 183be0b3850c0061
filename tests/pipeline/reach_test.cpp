// SPDX-License-Identifier: Apache-2.0
// The balls that bound where links can be, against random positions of random arms.
#include "../support/test.hpp"

#include <penumbra/poses/reach.hpp>

namespace penumbra::test {
namespace {

constexpr std::array types{"revolute", "continuous", "prismatic", "fixed"};

/// A chain of boxes with a branch after each second link.
std::string random_arm(std::mt19937_64& random) {
  std::uniform_real_distribution<double> metres(-0.3, 0.3), size(0.02, 0.2), angle(-3.0, 3.0);
  const auto triple = [&](auto& of) {
    std::ostringstream text;
    text << of(random) << ' ' << of(random) << ' ' << of(random);
    return text.str();
  };
  std::ostringstream urdf;
  urdf << "<robot name=\"random\">";
  for (int i = 0; i < 9; ++i)
    urdf << "<link name=\"l" << i << "\"><collision><origin xyz=\"" << triple(metres)
         << "\"/><geometry><box size=\"" << triple(size) << "\"/></geometry></collision></link>";
  for (int i = 1; i < 9; ++i)
    urdf << "<joint name=\"j" << i << "\" type=\"" << types[random() % types.size()]
         << "\"><parent link=\"l" << (i % 3 == 0 ? i - 2 : i - 1) << "\"/><child link=\"l" << i
         << "\"/><origin xyz=\"" << triple(metres) << "\" rpy=\"" << triple(angle)
         << "\"/><axis xyz=\"" << triple(metres)
         << "\"/><limit lower=\"-0.1\" upper=\"0.25\" effort=\"1\" velocity=\"1\"/></joint>";
  urdf << "</robot>";
  return urdf.str();
}

TEST(Reach, HoldsAllVerticesAtAnyPosition) {
  auto random = seeded_random(11);
  constexpr double rounding = 1e-6;  // metres: vertices are floats
  double fullest = 0.0;              // largest distance from a ball's centre, of its radius
  for (int arm = 0; arm < 20; ++arm) {
    const Robot robot = Robot::parse(random_arm(random), ".");
    const std::vector<Ball> reach = reach_of_links(robot);
    std::vector<double> positions(robot.variables().size());
    std::vector<Isometry3d> poses(robot.links().size());
    for (int sample = 0; sample < 300; ++sample) {
      for (const Joint& joint : robot.joints())
        if (joint.variable)
          positions[*joint.variable] =
              joint.type == JointType::prismatic
                  ? std::uniform_real_distribution(*joint.lower, *joint.upper)(random)
                  : std::uniform_real_distribution(-4.0, 4.0)(random);
      robot.forward_kinematics(positions, poses);
      for (std::size_t link = 0; link < poses.size(); ++link)
        for (const PreparedMesh& mesh : robot.meshes(link))
          for (const Vector3f& vertex : mesh.vertices) {
            const double distance = (poses[link] * vertex.cast<double>() - reach[0].centre).norm();
            ASSERT_LE(distance, reach[0].radius + rounding) << robot.links()[link];
            fullest = std::max(fullest, distance / reach[0].radius);
          }
    }
  }
  EXPECT_GT(fullest, 0.8) << "the balls are no larger than needed";
}

}  // namespace
}  // namespace penumbra::test
