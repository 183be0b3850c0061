// SPDX-License-Identifier: Apache-2.0
// The clean-up and the fringe on scenes with a known answer.
#include "scene.hpp"

namespace penumbra::test {
namespace {

class Cleanup : public IsaTest {
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
    for (const auto [u, v] : each_pixel(u0, v0, u1, v1)) image(u, v) = z;
  }

  std::size_t front_pixels() {
    Classifier classifier(width, height, LabelRule{}, GetParam());
    return classifier.classify(scene.view(), scene.metres.view()).pixels[std::size_t(Label::front)];
  }

  Scene scene;
};

PENUMBRA_FOR_EACH_ISA(Cleanup);

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

// The fringe on scenes whose answer is known: a robot of vertical sides before a far wall, whose
// depth the sensor carries sideways.

constexpr int image_width = 320, image_height = 96;
constexpr int robot_end = 100;  // the robot covers columns [40, 100)
constexpr float robot_z = 1.0f, wall_z = 2.5f;

LabelRule with_reach(int pixels) {
  LabelRule rule;
  rule.fringe_reach = pixels;
  return rule;
}

/// The robot in rows [20, 76), seen where it is, and the wall.
Scene robot_before_wall() {
  Scene scene(image_width, image_height);
  std::fill_n(scene.metres.data(), scene.metres.size(), wall_z);
  for (int v = 20; v < 76; ++v)
    for (int u = 40; u < robot_end; ++u) scene.robot(u, v) = scene.metres(u, v) = robot_z;
  scene.mark_tiles();
  return scene;
}

/// What the sensor measures in columns [u0, u1) of the robot's rows.
void see(Scene& scene, int u0, int u1, float depth) {
  for (const auto [u, v] : each_pixel(u0, 20, u1, 76)) scene.metres(u, v) = depth;
}

class Fringe : public IsaTest {
 protected:
  LabelView classify(const Scene& scene, const LabelRule& rule = {}) {
    classifier_.emplace(image_width, image_height, rule, GetParam());
    return classifier_->classify(scene.view(), scene.metres.view());
  }

  /// The fringe's pixels, in columns of the robot's rows.
  double fringe_columns(const Scene& scene, const LabelRule& rule = {}) {
    return double(count(classify(scene, rule), Label::fringe)) / 56.0;
  }

 private:
  std::optional<Classifier> classifier_;
};

TEST_P(Fringe, IsTheDepthThatTheSensorCarriedPastTheOutline) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 12, robot_z);
  const LabelView view = classify(scene);
  EXPECT_EQ(count(view, Label::fringe), 12u * 56u);
  for (const int u : {robot_end, robot_end + 11})
    EXPECT_EQ(view.labels(u, 48), std::uint8_t(Label::fringe)) << u;
  EXPECT_EQ(count(view, Label::clear), std::size_t(image_width * image_height - (60 + 12) * 56));
}

TEST_P(Fringe, EndsAtTheReach) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 120, robot_z);
  EXPECT_EQ(fringe_columns(scene), 40.0);
  EXPECT_EQ(fringe_columns(scene, with_reach(12)), 12.0);
  EXPECT_EQ(fringe_columns(scene, with_reach(0)), 0.0);
  EXPECT_EQ(fringe_columns(scene, LabelRule::paper()), 0.0);
}

TEST_P(Fringe, EndsWhereTheDepthHasLeftTheRobots) {
  Scene scene = robot_before_wall();
  for (int i = 0; i < 40; ++i)
    see(scene, robot_end + i, robot_end + i + 1, robot_z + 0.003f * float(i));
  // 3 e(1 m) = 63 mm are reached within 21 steps of 3 mm.
  EXPECT_EQ(fringe_columns(scene), 22.0);
}

TEST_P(Fringe, IsNoObjectThatStandsBesideTheRobotAtAnotherDepth) {
  for (const float step : {-0.1f, -0.05f, 0.05f, 0.1f}) {
    Scene scene = robot_before_wall();
    see(scene, robot_end, robot_end + 60, robot_z + step);
    EXPECT_EQ(fringe_columns(scene), 0.0) << step;
  }
}

TEST_P(Fringe, DoesNotLeakThroughSingleMixedPixels) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 60, robot_z + 0.03f);
  for (int v = 24; v < 76; v += 8) {  // a ramp of two pixels from the robot to the object
    scene.metres(robot_end, v) = robot_z + 0.01f;
    scene.metres(robot_end + 1, v) = robot_z + 0.02f;
  }
  const LabelView view = classify(scene);
  constexpr auto ramps = 4u * 7u;  // pixels of the blocks that hold them
  EXPECT_LE(count(view, Label::fringe), ramps);
}

TEST_P(Fringe, IsNotLookedForPastWhatIsNoMeasurement) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 10, 0.0f);
  see(scene, robot_end + 10, robot_end + 20, robot_z);
  EXPECT_EQ(fringe_columns(scene), 0.0);
}

TEST_P(Fringe, DoesNotSpreadFromWhereTheSensorSeesPastTheModel) {
  Scene scene = robot_before_wall();
  see(scene, robot_end - 6, robot_end, wall_z);  // the model is larger than the robot there
  const LabelView view = classify(scene);
  EXPECT_EQ(count(view, Label::beyond), 6u * 56u);
  EXPECT_EQ(count(view, Label::fringe), 0u);
}

PENUMBRA_FOR_EACH_ISA(Fringe);

}  // namespace
}  // namespace penumbra::test
