// SPDX-License-Identifier: Apache-2.0
// The clean-up on scenes with a known answer.
#include "scene.hpp"

#include <gtest/gtest.h>

#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

using test::Scene;

class Cleanup : public testing::TestWithParam<std::string> {
 protected:
  static constexpr int width = 160, height = 96;
  static constexpr float wall = 2.0f, robot = 1.0f, object = 0.9f;

  /// A robot in columns 40..119 before a wall.
  Cleanup() : scene(width, height) {
    fill(scene.metres, wall, 0, 0, width, height);
    fill(scene.robot, robot, 40, 0, 120, height);
    fill(scene.metres, robot, 40, 0, 120, height);
    scene.mark_tiles();
  }

  static void fill(Image<float>& image, float z, int u0, int v0, int u1, int v1) {
    for (int v = v0; v < v1; ++v)
      for (int u = u0; u < u1; ++u) image(u, v) = z;
  }

  std::size_t front_pixels() {
    Classifier classifier(width, height, LabelRule{}, GetParam());
    return classifier.classify(scene.view(), scene.metres.view())
        .pixels[static_cast<std::size_t>(Label::front)];
  }

  Scene scene;
};

INSTANTIATE_TEST_SUITE_P(Isa, Cleanup, testing::ValuesIn(simd_target_names()),
                         [](const auto& isa) { return isa.param; });

TEST_P(Cleanup, DropsWhatIsNarrow) {
  fill(scene.metres, object, 60, 10, 66, 60);  // six pixels wide, front_min_width is 7
  EXPECT_EQ(front_pixels(), 0u);
  fill(scene.metres, object, 60, 10, 67, 60);
  EXPECT_EQ(front_pixels(), 350u);
}

TEST_P(Cleanup, KeepsTheStripOfAnObjectThatReachesPastTheRobot) {
  fill(scene.metres, object, 117, 30, 140, 60);  // three pixels of it are on the robot
  EXPECT_EQ(front_pixels(), 90u);
}

TEST_P(Cleanup, DropsANearLinkSeenOutOfPlace) {
  // A near link in columns 80..119 that the sensor sees eight pixels further left.
  fill(scene.robot, 0.6f, 80, 0, 120, height);
  fill(scene.metres, 0.6f, 72, 0, 120, height);
  EXPECT_EQ(front_pixels(), 0u);
}

TEST_P(Cleanup, AHoledObjectStaysWhole) {
  fill(scene.metres, object, 60, 30, 90, 60);
  std::size_t holes = 0;
  for (int v = 32; v < 58; v += 2)
    for (int u = 60; u < 90; ++u, ++holes) scene.metres(u, v) = 0.0f;
  EXPECT_EQ(front_pixels(), 900u - holes);
}

TEST_P(Cleanup, UntouchedTilesBesideTheRobotSupportItsObjects) {
  // The robot ends with its tile, so that what carries its last columns lies in an untouched one.
  fill(scene.robot, 0.0f, 96, 0, width, height);
  scene.mark_tiles();
  ASSERT_EQ(scene.tiles.rows[4] >> 3, 0u);
  fill(scene.metres, wall, 96, 0, width, height);
  fill(scene.metres, object, 93, 30, 125, 60);
  EXPECT_EQ(front_pixels(), 90u);
}

}  // namespace
}  // namespace penumbra
