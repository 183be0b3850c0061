// SPDX-License-Identifier: Apache-2.0
// One joint that several programs tell: who agrees, who contradicts, and whose value is taken.
#include "told_sources.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

// Of a driver's own track along a way that bends a little, 1 mrad at 13 rad/s, in 0.18 s.
constexpr double of_driver = 1e-3 * 13.0 * 13.0 * 0.18 * 0.18 / 8.0;

constexpr std::int64_t all_stamps = 1900;  // stamps from 50 ms to 1950 ms, where everyone is heard

TEST(JointSources, OneAloneIsNotCompared) {
  // An encoder that is read at half the rate, a wheel of 30 rad/s, a gripper that snaps.
  const Way held = [](std::int64_t t) {
    const std::int64_t read = t / (20 * ms) * 20 * ms;
    return 10e-9 * static_cast<double>(read);
  };
  const Way snapping = [](std::int64_t t) { return t / (100 * ms) % 2 == 0 ? 0.0 : 0.8; };
  for (const Way& way : {held, moving(30.0), snapping}) {
    OneJoint joint;
    joint.hear({{.source = "driver", .way = way}});
    EXPECT_EQ(joint.count(JointStatus::ok, 50 * ms, 1950 * ms), all_stamps);
  }
}

struct Rates {
  std::int64_t driver, other;  // periods, ms
  std::int64_t offset;         // of their stamps, ms
};

class TwoPrograms : public testing::TestWithParam<Rates> {
 protected:
  std::vector<Program> pair(const Way& driver, const Way& other) {
    const auto [period, other_period, offset] = GetParam();
    return {{.source = "driver", .way = driver, .period = period * ms},
            {.source = "other", .way = other, .period = other_period * ms, .first = offset * ms}};
  }
};

TEST_P(TwoPrograms, ForgottenSlidersAreDisputed) {
  for (const Way& way : {standing(0.5), moving(0.6), moving(3.0), moving(-3.0)}) {
    OneJoint joint;
    joint.hear(pair(way, standing(0.0)));
    // Also where the arm passes the sliders' pose, unless they are so slow that they are compared
    // where both are there: then it is the arm's pose.
    for (std::int64_t stamp = 250 * ms; stamp < 1750 * ms; stamp += ms) {
      if (joint.at(stamp).status == JointStatus::disputed) continue;
      ASSERT_GT(std::max(GetParam().driver, GetParam().other), 100) << stamp;
      ASSERT_EQ(joint.at(stamp).status, JointStatus::ok) << stamp;
      ASSERT_NEAR(joint.at(stamp).positions[0], way(stamp), of_straight_way) << stamp;
    }
    const JointAnswer& answer = joint.at(1500 * ms);
    ASSERT_EQ(answer.disputes.size(), 1U);
    const JointDispute& dispute = answer.disputes[0];
    EXPECT_EQ(dispute.variable, 0U);
    EXPECT_LE(std::abs(dispute.stamp - 1500 * ms), 200 * ms);
    const std::size_t driver = dispute.sources[0] == "driver" ? 0 : 1;
    EXPECT_EQ(dispute.sources[driver], "driver");
    EXPECT_EQ(dispute.sources[1 - driver], "other");
    EXPECT_NEAR(dispute.values[driver], way(dispute.stamp), of_straight_way);
    EXPECT_EQ(dispute.values[1 - driver], 0.0);
  }
}

TEST_P(TwoPrograms, OneTruthIsTakenFromBoth) {
  for (const Way& way : {standing(0.5), moving(0.6), moving(-3.0)}) {
    OneJoint joint;
    joint.hear(pair(way, way));
    for (std::int64_t stamp = 250 * ms; stamp < 1750 * ms; stamp += ms) {
      ASSERT_EQ(joint.at(stamp).status, JointStatus::ok) << stamp;
      ASSERT_NEAR(joint.at(stamp).positions[0], way(stamp), of_straight_way);
    }
  }
}

TEST_P(TwoPrograms, ACopyIsTakenForACopy) {
  // The other one sends what it heard last, 12 ms late, with its own stamp; it may be heard first.
  // What is taken is the driver's.
  const Way way = moving_on(2.0);
  OneJoint joint;
  std::vector<Program> programs = pair(way, way);
  programs[0].latency = 3 * ms;
  programs[1].way = copy_of(programs[0], 12 * ms);
  joint.hear(programs);
  std::int64_t right = 0;
  for (std::int64_t stamp = 250 * ms; stamp < 1750 * ms; stamp += ms) {
    ASSERT_EQ(joint.at(stamp).status, JointStatus::ok) << stamp;
    if (std::abs(joint.at(stamp).positions[0] - way(stamp)) < of_driver) ++right;
  }
  EXPECT_EQ(right, 1500);
}

INSTANTIATE_TEST_SUITE_P(Rates, TwoPrograms,
                         testing::Values(Rates{10, 10, 0}, Rates{10, 10, 5}, Rates{10, 100, 3},
                                         Rates{100, 10, 3}, Rates{2, 20, 1}, Rates{33, 20, 0},
                                         Rates{8, 8, 1}, Rates{1, 100, 0}, Rates{20, 180, 7},
                                         Rates{180, 20, 7}));

TEST(JointSources, OnTheSameStampsBothAreKept) {
  OneJoint joint;
  for (std::int64_t t = 10 * ms; t < 100 * ms; t += 10 * ms) {
    joint.add(t, 0.3, "driver");
    joint.add(t, 0.0, "sliders");
  }
  EXPECT_EQ(joint.at(50 * ms).status, JointStatus::disputed);
  OneJoint alone;
  alone.add(10 * ms, 0.3, "driver");
  alone.add(10 * ms, 0.4, "driver");
  EXPECT_EQ(alone.at(10 * ms).positions[0], 0.4);
}

TEST(JointSources, TheFirstStateIsEnough) {
  OneJoint joint;
  for (std::int64_t t = 0; t <= 1000 * ms; t += 10 * ms) joint.add(t, 0.3, "driver");
  EXPECT_EQ(joint.at(110 * ms).status, JointStatus::ok);
  joint.add(105 * ms, 0.0, "sliders");
  EXPECT_EQ(joint.at(110 * ms).status, JointStatus::disputed);
  EXPECT_EQ(joint.at(310 * ms).status, JointStatus::stale)
      << "it may have been a copy of before, or the driver: its next state is waited for";
  joint.add(125 * ms, 0.0, "sliders");
  joint.add(145 * ms, 0.0, "sliders");
  EXPECT_EQ(joint.at(310 * ms).status, JointStatus::disputed) << "now it is certain";
}

TEST(JointSources, AJointMayGoAnywhereBetweenTwoStates) {
  // Half-way between the driver's states the second program sees it swing out by 0.1 rad.
  OneJoint joint;
  for (std::int64_t i = 0; i < 20; ++i) joint.add(100 * i * ms, 0.3, "driver");
  for (std::int64_t i = 0; i < 40; ++i) joint.add((50 * i + 7) * ms, i == 21 ? 0.4 : 0.3, "second");
  EXPECT_EQ(joint.count(JointStatus::disputed, 0, 2000 * ms), 0);
  EXPECT_EQ(joint.count(JointStatus::ok, 50 * ms, 1000 * ms), 950);
  EXPECT_EQ(joint.at(1057 * ms).status, JointStatus::stale) << "the two are not one there";
  EXPECT_EQ(joint.count(JointStatus::ok, 1110 * ms, 1850 * ms), 740);
}

TEST(JointSources, ADriverThatAlternatesItsNamesAgreesWithItself) {
  // As a bag shows it: messages with all joints, and some with a few of them.
  for (const double speed : {0.0, 1.0, 12.0}) {
    OneJoint joint;
    std::vector<Told> told;
    for (std::int64_t i = 0; i < 100; ++i)
      told.push_back({20 * i * ms, 20 * i * ms, moving(speed)(20 * i * ms),
                      i % 3 == 0 ? "all joints" : "some joints"});
    joint.hear(told);
    for (std::int64_t stamp = 50 * ms; stamp < 1900 * ms; stamp += ms) {
      ASSERT_EQ(joint.at(stamp).status, JointStatus::ok) << stamp;
      ASSERT_NEAR(joint.at(stamp).positions[0], moving(speed)(stamp), of_straight_way);
    }
  }
}

TEST(JointSources, BetweenThoseOfTwoSlowOnesNothingIsKnown) {
  for (const std::int64_t period : {300 * ms, 500 * ms}) {
    OneJoint joint;
    joint.hear({{.source = "a", .way = standing(0.0), .period = period},
                {.source = "b", .way = standing(0.5), .period = period, .first = 150 * ms}});
    EXPECT_LT(joint.count(JointStatus::ok, 0, 2000 * ms), 14) << "on their own states alone";
  }
}

TEST(JointSources, WheelsTurnOnWhoeverTellsThem) {
  // 12 rad/s, one program counts turns, one does not; both read an encoder at half their rate.
  const auto held = [](std::int64_t period) {
    return [=](std::int64_t t) { return moving(12.0)(t / (2 * period) * 2 * period); };
  };
  const Way wrapped = [&](std::int64_t t) {
    return std::remainder(held(25 * ms)(t), 2.0 * std::numbers::pi);
  };
  OneJoint joint("continuous");
  joint.hear({{.source = "driver", .way = held(20 * ms), .period = 20 * ms},
              {.source = "odometry", .way = wrapped, .period = 25 * ms}});
  EXPECT_EQ(joint.count(JointStatus::disputed, 0, 2000 * ms), 0);
}

TEST(JointSources, AProgramThatStartsAgainIsNoContradiction) {
  OneJoint joint;
  joint.hear({{.source = "publisher 1", .way = standing(0.5), .end = 600 * ms},
              {.source = "publisher 2", .way = standing(-0.4), .first = 1200 * ms}});
  EXPECT_EQ(joint.count(JointStatus::disputed, 0, 2000 * ms), 0);
  EXPECT_EQ(joint.at(550 * ms).positions[0], 0.5);
  EXPECT_EQ(joint.at(900 * ms).status, JointStatus::stale);
  EXPECT_EQ(joint.at(1245 * ms).status, JointStatus::ok)
      << "missed for two of its periods, and more";
  EXPECT_EQ(joint.at(1245 * ms).positions[0], -0.4);
}

TEST(JointSources, WhenOneOfThemEndsTheOtherIsTaken) {
  OneJoint joint;
  joint.hear({{.source = "sliders", .way = standing(0.0), .end = 1000 * ms},
              {.source = "driver", .way = moving(1.0)}});
  EXPECT_EQ(joint.count(JointStatus::disputed, 300 * ms, 700 * ms), 400);
  EXPECT_EQ(joint.count(JointStatus::ok, 1800 * ms, 1900 * ms), 100) << "0.8 s later";
  EXPECT_NEAR(joint.at(1800 * ms).positions[0], 0.8, of_straight_way);
}

TEST(JointSources, ADriverThatFallsSilentDoesNotProveTheOthersRight) {
  std::vector<Told> told;
  tell({.source = "driver", .way = standing(0.5), .end = 1000 * ms}, told);
  tell({.source = "driver", .way = standing(0.5), .first = 1600 * ms}, told);
  tell({.source = "sliders", .way = standing(0.0)}, told);
  OneJoint joint;
  joint.hear(std::move(told));
  EXPECT_EQ(joint.count(JointStatus::disputed, 300 * ms, 1900 * ms), 1600);
}

TEST(JointSources, AThirdOneDoesNotShortenAContradiction) {
  OneJoint joint;
  for (std::int64_t t = 0; t <= 1000 * ms; t += 10 * ms) {
    joint.add(t, 0.3, "driver");
    joint.add(t, 0.0, "sliders");
  }
  joint.add(1000 * ms, 0.7, "third");  // of which it is not known how it came there
  EXPECT_EQ(joint.at(1000 * ms).disputes.at(0).sources[1], "sliders");
}

TEST(JointSources, WhoIsSilentIsForgotten) {
  OneJoint joint("revolute", {.history = 1.0});
  joint.hear({{.source = "sliders", .way = standing(0.0), .end = 500 * ms},
              {.source = "driver", .way = moving(1.0), .end = 5000 * ms}});
  EXPECT_EQ(joint.count(JointStatus::ok, 4000 * ms, 4900 * ms), 900);
  joint.buffer().clear();
  EXPECT_EQ(joint.at(4500 * ms).status, JointStatus::missing);
}

TEST(JointSources, AStartFromTheSlidersPoseIsSeen) {
  // Both at 0 until the arm starts; the sliders are heard first, and are the faster ones.
  for (const std::int64_t period : {5 * ms, 10 * ms, 100 * ms}) {
    const Way starting = [](std::int64_t t) {
      const double s = std::max(0.0, 1e-9 * static_cast<double>(t - 1000 * ms));
      return 2.5 * s * s;
    };
    OneJoint joint;
    joint.hear({{.source = "sliders", .way = standing(0.0), .period = period},
                {.source = "driver", .way = starting, .latency = 4 * ms}});
    EXPECT_EQ(joint.count(JointStatus::disputed, 0, 700 * ms), 0);
    for (std::int64_t stamp = 700 * ms; stamp < 1900 * ms; stamp += ms) {
      if (joint.at(stamp).status == JointStatus::ok) {
        ASSERT_NEAR(joint.at(stamp).positions[0], starting(stamp), 0.01) << stamp;
      }
    }
    EXPECT_EQ(joint.count(JointStatus::disputed, 1200 * ms, 1750 * ms), 550);
  }
}

TEST(JointSources, AreNotComparedIfThatIsAsked) {
  OneJoint joint("revolute", {.compare_sources = false});
  joint.hear({{.source = "driver", .way = moving(1.0), .latency = -ms},
              {.source = "sliders", .way = standing(0.0)}});
  EXPECT_EQ(joint.count(JointStatus::ok, 50 * ms, 1950 * ms), all_stamps);
  EXPECT_NEAR(joint.at(1500 * ms).positions[0], 0.5, of_straight_way) << "the first one's";
}

TEST(JointSources, RotationsOfFloatingJointsAreCompared) {
  const Robot robot =
      parse(robot_xml(link_xml("a") + link_xml("b") + joint_xml("f", "floating", "a", "b")));
  JointBuffer buffer(robot);
  const std::vector<std::string> names = {"f/x", "f/y", "f/z", "f/qx", "f/qy", "f/qz", "f/qw"};
  JointAnswer answer;
  for (std::int64_t t = 0; t < 100 * ms; t += 10 * ms) {
    buffer.insert(t, names, std::vector<double>{0, 0, 0, 0, 0, 0.6, 0.8}, "a");
    buffer.insert(t, names, std::vector<double>{0, 0, 0, 0, 0, -0.6, -0.8}, "b");
  }
  buffer.at(45 * ms, answer);
  EXPECT_EQ(answer.status, JointStatus::ok) << "one rotation with either sign";
  for (std::int64_t t = 100 * ms; t < 200 * ms; t += 10 * ms) {
    buffer.insert(t, names, std::vector<double>{0, 0, 0, 0, 0, 0.6, 0.8}, "a");
    buffer.insert(t, names, std::vector<double>{0, 0, 0, 0, 0, -0.6, 0.8}, "b");
  }
  buffer.at(155 * ms, answer);
  ASSERT_EQ(answer.status, JointStatus::disputed) << "74 degrees to the left, and to the right";
  ASSERT_EQ(answer.disputes.size(), 1U);
  EXPECT_EQ(robot.variables()[answer.disputes[0].variable], "f/qz");
  EXPECT_EQ(answer.disputes[0].values, (std::array{0.6, -0.6}));
}

TEST(JointSources, ASignThatFlipsIsNoOtherRotation) {
  const Robot robot =
      parse(robot_xml(link_xml("a") + link_xml("b") + joint_xml("f", "floating", "a", "b")));
  JointBuffer buffer(robot);
  const std::vector<std::string> names = {"f/x", "f/y", "f/z", "f/qx", "f/qy", "f/qz", "f/qw"};
  for (std::int64_t i = 0; i < 10; ++i) {
    const double sign = i % 3 == 0 ? -1.0 : 1.0;
    const std::vector<double> a{0, 0, 0, 0, 0, 0.6 * sign, 0.8 * sign}, b{0, 0, 0, 0, 0, 0.6, 0.8};
    buffer.insert(10 * i * ms, names, a, "a");
    buffer.insert((10 * i + 4) * ms, names, b, "b");
  }
  JointAnswer answer;
  for (std::int64_t t = 10 * ms; t < 90 * ms; t += ms) {
    buffer.at(t, answer);
    ASSERT_EQ(answer.status, JointStatus::ok) << t;
    ASSERT_NEAR(std::abs(answer.positions[5]), 0.6, of_straight_way);
  }
}

TEST(JointSources, AreKeptWithinBounds) {
  // As of a bag each of whose joint states has a frame_id of its own.
  OneJoint joint;
  for (std::int64_t i = 0; i < 20000; ++i) joint.add(i * ms, 0.3, std::to_string(i));
  const JointAnswer& answer = joint.at(19999 * ms + ms / 2);
  ASSERT_EQ(answer.status, JointStatus::stale);
  EXPECT_EQ(answer.gaps.at(0).source, std::to_string(20000 - 32)) << "the oldest of those kept";
}

TEST(SourceNames, AreRememberedWithinBounds) {
  SourceNames names;
  const std::uint32_t first = names.number_of("first");
  EXPECT_EQ(names.number_of("first"), first);
  EXPECT_EQ(names.name_of(first), "first");
  for (std::size_t i = 0; i < SourceNames::most; ++i) names.number_of(std::to_string(i));
  EXPECT_EQ(names.name_of(first), "another source");
  EXPECT_NE(names.number_of("first"), first) << "a number is one source's";
}

}  // namespace
}  // namespace penumbra::test
