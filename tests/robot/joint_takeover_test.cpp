// SPDX-License-Identifier: Apache-2.0
// Whose word is taken where several programs tell one joint, asked as frames are: as states arrive.
#include "told_sources.hpp"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

TEST(JointTakeover, TheOtherOneDoesNotTakeOverWhereTheDriverEnds) {
  // Sliders that contradicted it, and a copy that sends on its last value. What is known until it
  // ends is the driver's; then nothing, until the driver is forgotten.
  constexpr double bend = 1e-3 * 13.0 * 13.0 * 0.02 * 0.02 / 8.0;  // between its states, rad
  const Way way = moving_on(1.0);
  const Program driver{.source = "driver", .way = way, .period = 20 * ms, .end = 1000 * ms};
  for (const Way& other : {standing(-3.0), copy_of(driver, 0)}) {
    OneJoint joint;
    const auto out =
        joint.live({driver, {.source = "other", .way = other, .first = 5 * ms, .end = 8000 * ms}});
    for (const auto& [stamp, status, value] : out) {
      if (stamp < 250 * ms || status != JointStatus::ok) continue;
      ASSERT_LE(stamp, 980 * ms) << "what is known of " << value;
      ASSERT_NEAR(value, way(stamp), bend);
    }
    EXPECT_EQ(joint.count(JointStatus::ok, 1000 * ms, 7900 * ms), 0);
  }
}

TEST(JointTakeover, WhoMovesOnItsOwnTakesOver) {
  OneJoint joint;
  const auto out = joint.live({{.source = "a", .way = moving(1.0), .end = 1000 * ms},
                               {.source = "b", .way = moving(1.0), .first = 3 * ms}});
  std::int64_t back = 0;
  for (const auto& [stamp, status, value] : out) {
    if (stamp > 1000 * ms && back == 0 && status == JointStatus::ok) back = stamp;
    if (status == JointStatus::ok) {
      ASSERT_NEAR(value, moving(1.0)(stamp), of_straight_way);
    }
  }
  EXPECT_GT(back, 0);
  EXPECT_LE(back, 1500 * ms) << "0.4 s in which a copy may catch up, and what it takes to move";
}

TEST(JointTakeover, TheNextStateOfTheDriverIsWaitedFor) {
  // Its copy tells ten times as often, with stamps of its own.
  constexpr double bend = 1e-3 * 13.0 * 13.0 * 0.1 * 0.1 / 8.0;  // between its states, rad
  const Program driver{.source = "driver", .way = moving_on(1.0), .period = 100 * ms};
  OneJoint joint;
  const auto out =
      joint.live({driver, {.source = "copy", .way = copy_of(driver, 0), .first = 3 * ms}});
  for (const auto& [stamp, status, value] : out) {
    if (stamp < 350 * ms) continue;  // two of its numbers are known to be the driver's
    ASSERT_EQ(status, JointStatus::ok) << stamp;
    ASSERT_NEAR(value, driver.way(stamp), bend) << stamp;
  }
}

TEST(JointTakeover, WhoeverBeginsIsNotBelievedBesideTheDriver) {
  for (const double elsewhere : {0.0, -2.0}) {
    OneJoint joint;
    const auto out =
        joint.live({{.source = "driver", .way = standing(1.0), .period = 100 * ms},
                    {.source = "other", .way = standing(elsewhere), .first = 1013 * ms}});
    std::size_t known = 0;
    for (const auto& [stamp, status, value] : out) {
      if (status != JointStatus::ok) continue;
      ++known;
      ASSERT_EQ(value, 1.0) << stamp;
      ASSERT_LT(stamp, 1100 * ms);
    }
    EXPECT_GT(known, 150U);
  }
}

TEST(JointTakeover, WhoTellsSeldomIsWaitedFor) {
  // One driver, whose states look different once in half a second. It might as well be a driver
  // and its copy.
  OneJoint joint;
  const auto out =
      joint.live({{.source = "whole", .way = moving(0.5), .period = 500 * ms, .end = 5000 * ms},
                  {.source = "short", .way = moving(0.5), .first = 3 * ms, .end = 5000 * ms}});
  std::size_t known = 0;
  for (const auto& [stamp, status, value] : out) {
    if (status != JointStatus::ok) continue;
    ++known;
    ASSERT_NEAR(value, moving(0.5)(stamp), of_straight_way);
  }
  EXPECT_GE(known, 10U) << "on its own states";
  EXPECT_LT(known, out.size() / 3);
}

TEST(JointTakeover, WithoutComparingTheFirstOneIsWaitedFor) {
  OneJoint joint("revolute", {.compare_sources = false});
  const auto out = joint.live({{.source = "driver", .way = moving(1.0), .latency = 30 * ms},
                               {.source = "sliders", .way = standing(0.0), .first = 40 * ms}});
  std::size_t known = 0;
  for (const auto& [stamp, status, value] : out) {
    if (status != JointStatus::ok) continue;
    ++known;
    ASSERT_NEAR(value, moving(1.0)(stamp), of_straight_way);
  }
  EXPECT_GT(known, 300U);
}

TEST(JointTakeover, WithoutComparingADriverThatReturnsIsTheFirstAgain) {
  OneJoint joint("revolute", {.history = 1.0, .compare_sources = false});
  const auto out = joint.live(
      {{.source = "writer 1", .way = moving(1.0), .end = 600 * ms},
       {.source = "sliders", .way = standing(0.0), .first = 100 * ms, .end = 9000 * ms},
       {.source = "writer 2", .way = moving(1.0), .first = 1500 * ms, .end = 3000 * ms},
       {.source = "writer 3", .way = moving(1.0), .first = 7000 * ms, .end = 9000 * ms}});
  std::size_t known = 0;
  for (const auto& [stamp, status, value] : out) {
    if (status != JointStatus::ok) continue;
    ++known;
    ASSERT_NEAR(value, moving(1.0)(stamp), of_straight_way) << stamp;
  }
  EXPECT_GT(known, (590U + 1490U + 1900U) / 5U) << "all that a driver tells";
}

}  // namespace
}  // namespace penumbra::test
