// SPDX-License-Identifier: Apache-2.0
// The labels of single pixels against the rule in closed form, on every target.
#include "scene.hpp"

namespace penumbra::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

LabelRule without_cleanup() {
  LabelRule rule;
  rule.front_min_width = 0;
  rule.fringe_reach = 0;
  return rule;
}

class Rules : public IsaTest {
 protected:
  /// The label of one pixel, seen at every position of a vector; an integer is millimetres.
  template <typename T>
  Label label(const LabelRule& rule, float z, T d) {
    Scene scene(37, 1);
    std::fill_n(scene.robot.data(), 37, z);
    scene.mark_tiles();
    const Image<T> depth(37, 1, d);
    Classifier classifier(37, 1, rule, GetParam());
    const LabelView view = classifier.classify(scene.view(), depth.view());
    for (int u = 1; u < 37; ++u) EXPECT_EQ(view.labels(u, 0), view.labels(0, 0)) << u;
    EXPECT_EQ(view.pixels[view.labels(0, 0)], 37u);
    return static_cast<Label>(view.labels(0, 0));
  }
};

PENUMBRA_FOR_EACH_ISA(Rules);

TEST_P(Rules, ExactEdgesBelongToOccluded) {
  // Exact in binary: e(1) = 2^-6 + 2^-7 + 2^-8 and twice that.
  LabelRule rule = without_cleanup();
  rule.tolerance = {0x1p-6, 0x1p-7, 0x1p-8};
  const float e = 0x1p-6f + 0x1p-7f + 0x1p-8f;
  EXPECT_EQ(label(rule, 1.0f, 1.0f - e), Label::occluded);
  EXPECT_EQ(label(rule, 1.0f, std::nextafter(1.0f - e, 0.0f)), Label::front);
  EXPECT_EQ(label(rule, 1.0f, 1.0f + 2 * e), Label::occluded);
  EXPECT_EQ(label(rule, 1.0f, std::nextafter(1.0f + 2 * e, 2.0f)), Label::beyond);
}

TEST_P(Rules, NoMeasurementIsUnknownOnTheRobotAndClearBesideIt) {
  const LabelRule rule = without_cleanup();
  const float payload = std::bit_cast<float>(0x7fc12345u);
  const float signalling = std::bit_cast<float>(0xff812345u);
  for (const float d : {0.0f, -0.0f, -1.0f, infinity, -infinity, payload, -payload, signalling}) {
    EXPECT_EQ(label(rule, 1.0f, d), Label::unknown) << d;
    EXPECT_EQ(label(rule, 0.0f, d), Label::clear) << d;
  }
  EXPECT_EQ(label(rule, 1.0f, std::uint16_t{0}), Label::unknown);
  EXPECT_EQ(label(rule, 1.0f, std::uint16_t{65535}), Label::unknown) << "saturated";
  EXPECT_EQ(label(rule, 0.0f, std::uint16_t{65535}), Label::clear);
}

TEST_P(Rules, MillimetresAreThousandths) {
  const LabelRule rule = without_cleanup();
  EXPECT_EQ(label(rule, 1.0f, std::uint16_t{978}), Label::front);
  EXPECT_EQ(label(rule, 1.0f, std::uint16_t{980}), Label::occluded);
  EXPECT_EQ(label(rule, 1.0f, std::uint16_t{65534}), Label::beyond);
  EXPECT_EQ(label(rule, 70.0f, std::uint16_t{65534}), Label::occluded);  // not read as negative
  EXPECT_EQ(label(rule, 40.0f, std::uint16_t{1}), Label::front);
}

TEST_P(Rules, OutsideTheSensorsRangeIsNoMeasurement) {
  LabelRule rule = without_cleanup();
  rule.range = {0.5, 3.0};
  EXPECT_EQ(label(rule, 1.0f, 0.5f), Label::front);
  EXPECT_EQ(label(rule, 1.0f, std::nextafter(0.5f, 0.0f)), Label::unknown);
  EXPECT_EQ(label(rule, 1.0f, 3.0f), Label::beyond);
  EXPECT_EQ(label(rule, 1.0f, std::nextafter(3.0f, 4.0f)), Label::unknown);
  EXPECT_EQ(label(rule, 4.0f, 3.0f), Label::front);  // a robot farther than the range still counts
}

/// Occluded where d >= dV - 0.01 m.
TEST_P(Rules, PaperIsThePapersInequality) {
  for (const float z : {0.3f, 1.0f, 3.0f}) {
    EXPECT_EQ(label(LabelRule::paper(), z, z - 0.010001f), Label::front);
    for (const float d : {z - 0.009999f, z + 0.02f, 60.0f})
      EXPECT_EQ(label(LabelRule::paper(), z, d), Label::occluded) << d;
    EXPECT_EQ(label(LabelRule::paper(), z, 0.0f), Label::unknown);
  }
}

TEST(RuleCheck, AcceptsDefaultsPaperAndSensors) {
  EXPECT_NO_THROW(LabelRule{}.check());
  EXPECT_NO_THROW(LabelRule::paper().check());
  for (const char* name : {"realsense_d4xx", "zed", "tof", "structured_light", "none"})
    EXPECT_NO_THROW(LabelRule::for_sensor(name).check()) << name;
  EXPECT_EQ(LabelRule::for_sensor("none").fringe_reach, 0);
  LabelRule falling;
  falling.tolerance = {0.02, -0.02, 0.005};  // 0 at 2 m, its least
  EXPECT_NO_THROW(falling.check());
}

TEST(RuleCheck, RefusesAndSaysWhatItGot) {
  const std::pair<const char*, std::function<void(LabelRule&)>> bad[] = {
      {"tolerance -0.01,0,0",
       [](LabelRule& r) {
         r.tolerance = {-0.01, 0, 0};
       }},
      {"tolerance 0.02,-0.1,0.1",
       [](LabelRule& r) {
         r.tolerance = {0.02, -0.1, 0.1};
       }},
      {"tolerance 0.02,-0.01,0",
       [](LabelRule& r) {
         r.tolerance = {0.02, -0.01, 0};
       }},
      {"tolerance 0.9,0,-1e-06",
       [](LabelRule& r) {
         r.tolerance = {0.9, 0, -1e-6};
       }},
      {"metres", [](LabelRule& r) { r.tolerance.a = 1; }},  // millimetres
      {"metres", [](LabelRule& r) { r.tolerance.b = 5; }},
      {"tolerance inf", [](LabelRule& r) { r.tolerance.a = infinity; }},
      {"nan", [](LabelRule& r) { r.tolerance.c = nan; }},
      {"factor 0.9", [](LabelRule& r) { r.beyond_factor = 0.9; }},
      {"factor nan", [](LabelRule& r) { r.beyond_factor = nan; }},
      {"front_min_width -1", [](LabelRule& r) { r.front_min_width = -1; }},
      {"front_min_width 64", [](LabelRule& r) { r.front_min_width = 64; }},
      {"edge_margin 65", [](LabelRule& r) { r.edge_margin = 65; }},
      {"-1", [](LabelRule& r) { r.fringe_reach = -1; }},
      {"256", [](LabelRule& r) { r.fringe_reach = 256; }},
      {"range 3..3",
       [](LabelRule& r) {
         r.range = {3, 3};
       }},
      {"range nan", [](LabelRule& r) { r.range.near = nan; }}};
  for (const auto& [part, change] : bad) {
    LabelRule rule;
    change(rule);
    expect_refused([&] { rule.check(); }, {part});
    EXPECT_THROW(Classifier(8, 8, rule), InputError) << part;
  }
  expect_refused([] { (void)LabelRule::for_sensor("kinect"); }, {"kinect"});
}

// The clean-up and the fringe on scenes with a known answer.

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
