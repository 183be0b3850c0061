// SPDX-License-Identifier: Apache-2.0
// The fringe on scenes whose answer is known: a robot of vertical sides before a far wall, whose
// depth the sensor carries sideways.
#include "scene.hpp"

#include <gtest/gtest.h>

#include <penumbra/labels/labels.hpp>

namespace penumbra {
namespace {

using test::Scene;

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
  for (int v = 20; v < 76; ++v)
    for (int u = u0; u < u1; ++u) scene.metres(u, v) = depth;
}

class Fringe : public testing::TestWithParam<std::string> {
 protected:
  LabelView classify(const Scene& scene, const LabelRule& rule = {}) {
    classifier_.emplace(image_width, image_height, rule, GetParam());
    return classifier_->classify(scene.view(), scene.metres.view());
  }

  /// Columns [u0, u1) of a row of fringe; {0, 0}: none.
  static std::pair<int, int> fringe_columns(const LabelView& view, int v) {
    const auto is_fringe = [&](int u) {
      return view.labels(u, v) == static_cast<std::uint8_t>(Label::fringe);
    };
    int u0 = 0;
    while (u0 < image_width && !is_fringe(u0)) ++u0;
    int u1 = u0;
    while (u1 < image_width && is_fringe(u1)) ++u1;
    return u0 == image_width ? std::pair(0, 0) : std::pair(u0, u1);
  }

 private:
  std::optional<Classifier> classifier_;
};

TEST_P(Fringe, IsTheDepthThatTheSensorCarriedPastTheOutline) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 12, robot_z);
  const LabelView view = classify(scene);
  EXPECT_EQ(fringe_columns(view, 48), std::pair(robot_end, robot_end + 12));
  EXPECT_EQ(view.pixels[static_cast<std::size_t>(Label::fringe)], 12u * 56u);
  EXPECT_EQ(view.pixels[static_cast<std::size_t>(Label::clear)],
            static_cast<std::size_t>(image_width * image_height - (60 + 12) * 56));
}

TEST_P(Fringe, EndsAtTheReach) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 120, robot_z);
  EXPECT_EQ(fringe_columns(classify(scene), 48), std::pair(robot_end, robot_end + 40));
  EXPECT_EQ(fringe_columns(classify(scene, with_reach(12)), 48),
            std::pair(robot_end, robot_end + 12));
  EXPECT_EQ(fringe_columns(classify(scene, with_reach(0)), 48), std::pair(0, 0));
  EXPECT_EQ(fringe_columns(classify(scene, LabelRule::paper()), 48), std::pair(0, 0));
}

TEST_P(Fringe, EndsWhereTheDepthHasLeftTheRobots) {
  Scene scene = robot_before_wall();
  for (int i = 0; i < 40; ++i)
    see(scene, robot_end + i, robot_end + i + 1, robot_z + 0.003f * static_cast<float>(i));
  // 3 e(1 m) = 63 mm are reached within 21 steps of 3 mm.
  EXPECT_EQ(fringe_columns(classify(scene), 48), std::pair(robot_end, robot_end + 22));
}

TEST_P(Fringe, IsNoObjectThatStandsBesideTheRobotAtAnotherDepth) {
  for (const float step : {-0.1f, -0.05f, 0.05f, 0.1f}) {
    Scene scene = robot_before_wall();
    see(scene, robot_end, robot_end + 60, robot_z + step);
    EXPECT_EQ(classify(scene).pixels[static_cast<std::size_t>(Label::fringe)], 0u) << step;
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
  EXPECT_LE(view.pixels[static_cast<std::size_t>(Label::fringe)], ramps);
}

TEST_P(Fringe, IsNotLookedForPastWhatIsNoMeasurement) {
  Scene scene = robot_before_wall();
  see(scene, robot_end, robot_end + 10, 0.0f);
  see(scene, robot_end + 10, robot_end + 20, robot_z);
  EXPECT_EQ(classify(scene).pixels[static_cast<std::size_t>(Label::fringe)], 0u);
}

TEST_P(Fringe, DoesNotSpreadFromWhereTheSensorSeesPastTheModel) {
  Scene scene = robot_before_wall();
  see(scene, robot_end - 6, robot_end, wall_z);  // the model is larger than the robot there
  const LabelView view = classify(scene);
  EXPECT_EQ(view.pixels[static_cast<std::size_t>(Label::beyond)], 6u * 56u);
  EXPECT_EQ(view.pixels[static_cast<std::size_t>(Label::fringe)], 0u);
}

TEST_P(Fringe, ReachesTheImagesBorder) {
  Scene scene(image_width, image_height);
  std::fill_n(scene.metres.data(), scene.metres.size(), robot_z);
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u) scene.robot(u, v) = robot_z;
  scene.mark_tiles();
  const LabelView view = classify(scene, with_reach(255));
  EXPECT_EQ(view.labels(0, image_height - 1), static_cast<std::uint8_t>(Label::fringe));
  EXPECT_EQ(view.labels(200, image_height - 1), static_cast<std::uint8_t>(Label::fringe));
}

INSTANTIATE_TEST_SUITE_P(, Fringe, testing::ValuesIn(simd_target_names()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace penumbra
