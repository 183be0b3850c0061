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
  Label label(const LabelRule& rule, float z, float d) { return only_label(rule, z, d); }
  Label label_millimetres(const LabelRule& rule, float z, std::uint16_t d) {
    return only_label(rule, z, d);
  }

 private:
  /// The label of one pixel, seen at every position of a vector.
  template <typename T>
  Label only_label(const LabelRule& rule, float z, T d) {
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
  EXPECT_EQ(label_millimetres(rule, 1.0f, 0), Label::unknown);
  EXPECT_EQ(label_millimetres(rule, 1.0f, 65535), Label::unknown) << "saturated";
  EXPECT_EQ(label_millimetres(rule, 0.0f, 65535), Label::clear);
}

TEST_P(Rules, MillimetresAreThousandths) {
  const LabelRule rule = without_cleanup();
  EXPECT_EQ(label_millimetres(rule, 1.0f, 978), Label::front);
  EXPECT_EQ(label_millimetres(rule, 1.0f, 980), Label::occluded);
  EXPECT_EQ(label_millimetres(rule, 1.0f, 65534), Label::beyond);
  EXPECT_EQ(label_millimetres(rule, 70.0f, 65534), Label::occluded);  // not read as negative
  EXPECT_EQ(label_millimetres(rule, 40.0f, 1), Label::front);
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

}  // namespace
}  // namespace penumbra::test
