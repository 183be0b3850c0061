// SPDX-License-Identifier: Apache-2.0
// One of several programs that tell one joint falls silent, lags or tells seldom: nothing is known
// then, or what is known is right. Asked as frames are, as states arrive.
#include "told_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

class HeardFirst : public testing::TestWithParam<std::int64_t> {};  // the driver's period, ms

TEST_P(HeardFirst, SlidersAreNotTheArmThatStartsFromTheirPose) {
  const Way arm = starting_at(1000 * ms);
  OneJoint joint;
  const auto out =
      joint.live({{.source = "sliders", .way = standing(0.0), .first = 3 * ms},
                  {.source = "driver", .way = arm, .period = GetParam() * ms, .first = 20 * ms}});
  const Frames before = check(out, arm, 250 * ms, 650 * ms);
  EXPECT_EQ(before.known, before.all);
  check(out, arm, 0, 2000 * ms);
  EXPECT_EQ(check(out, arm, 1300 * ms, 2000 * ms).known, 0);
}

TEST_P(HeardFirst, ACopyIsNotTheDriver) {
  // Round the driver's turns, too: its straight ways between states are within 0.01 rad there.
  const Way arm = [](std::int64_t t) { return 0.4 * std::sin(3.5e-9 * static_cast<double>(t)); };
  const Program driver{.source = "driver",
                       .way = arm,
                       .period = GetParam() * ms,
                       .first = 20 * ms,
                       .end = 6000 * ms};
  const Way copy = copy_of(driver, 4 * ms);
  OneJoint joint;
  const auto out =
      joint.live({{.source = "copy", .way = copy, .first = 3 * ms, .end = 6000 * ms}, driver});
  const Frames frames = check(out, arm, 500 * ms, 6000 * ms);
  EXPECT_EQ(frames.known, frames.all);
}

TEST_P(HeardFirst, ACopyAtRestIsNotBelievedWhenTheDriverDies) {
  const Way arm = starting_at(1800 * ms, 0.5);  // which nobody tells any more
  OneJoint joint;
  const auto out =
      joint.live({{.source = "copy", .way = standing(0.0), .first = 3 * ms, .end = 9000 * ms},
                  {.source = "driver",
                   .way = arm,
                   .period = GetParam() * ms,
                   .first = 20 * ms,
                   .end = 1500 * ms}});
  EXPECT_GT(check(out, arm, 0, 1500 * ms).known, 200);
  EXPECT_EQ(check(out, arm, 1500 * ms, 9000 * ms).known, 0);
}

TEST_P(HeardFirst, ACopyIsNotBelievedWhenTheDriverDiesAtWork) {
  const Way arm = starting_at(500 * ms, 100.0);
  const Program driver{.source = "driver", .way = arm, .period = GetParam() * ms};
  const Way copy = copy_of(driver, 4 * ms);
  OneJoint joint;
  const auto out =
      joint.live({{.source = "copy", .way = copy, .first = 3 * ms, .end = 15000 * ms}, driver});
  EXPECT_GT(check(out, arm, 0, 2000 * ms).known, 300);
  EXPECT_EQ(check(out, arm, 2000 * ms, 15000 * ms).known, 0) << "also when 10 s are over";
}

TEST_P(HeardFirst, ACopyDoesNotHideADriverThatIsStartedAgain) {
  const Way arm = starting_at(500 * ms, 1.2);
  const Program writer{
      .source = "writer 1", .way = arm, .period = GetParam() * ms, .end = 1300 * ms};
  Program again = writer;
  again.source = "writer 2", again.first = 3000 * ms, again.end = 5000 * ms;
  const Way copy = [first = copy_of(writer, 4 * ms), second = copy_of(again, 4 * ms)](
                       std::int64_t t) { return t < 3010 * ms ? first(t) : second(t); };
  OneJoint joint;
  const auto out = joint.live(
      {{.source = "copy", .way = copy, .first = 3 * ms, .end = 5000 * ms}, writer, again});
  EXPECT_EQ(check(out, arm, 1300 * ms, 3000 * ms).known, 0);
  const Frames back = check(out, arm, 4200 * ms, 4800 * ms);
  EXPECT_EQ(back.known, back.all);
}

INSTANTIATE_TEST_SUITE_P(Periods, HeardFirst, testing::Values(10, 20, 50, 100));

TEST(JointSilence, NobodyAnswersInAGapOfTheDriver) {
  // It begins to move there.
  const Way arm = starting_at(1000 * ms);
  for (const std::int64_t gap : {210 * ms, 300 * ms, 390 * ms}) {
    const Way copy = [&](std::int64_t t) {
      return t > 1000 * ms && t < 1000 * ms + gap ? 0.0 : arm(t / (10 * ms) * 10 * ms);
    };
    for (const Way& other : {standing(0.0), copy}) {
      std::vector<Told> told;
      tell({.source = "driver", .way = arm}, told);
      std::erase_if(told, [&](const Told& each) {
        return each.stamp > 1000 * ms && each.stamp < 1000 * ms + gap;
      });
      tell({.source = "other", .way = other, .first = 5 * ms}, told);
      OneJoint joint;
      check(joint.live(std::move(told)), arm, 0, 2000 * ms);
    }
  }
}

TEST(JointSilence, ASeldomDriverIsNotItsCopy) {
  const Way arm = starting_at(1500 * ms);
  for (const std::int64_t period : {210 * ms, 300 * ms, 500 * ms}) {
    const Program driver{.source = "driver", .way = arm, .period = period, .end = 5000 * ms};
    for (const Way& other : {standing(0.0), copy_of(driver, 4 * ms)}) {
      OneJoint joint;
      const auto out = joint.live(
          {driver, {.source = "other", .way = other, .first = 5 * ms, .end = 5000 * ms}});
      check(out, arm, 0, 5000 * ms, tolerance + 2e-3);  // what its way bends in half a second
    }
  }
}

TEST(JointSilence, SlidersThatBeginBesideASeldomDriverAreNotBelieved) {
  OneJoint joint;
  const auto out = joint.live({{.source = "driver", .way = standing(1.0), .period = 500 * ms},
                               {.source = "sliders", .way = standing(0.0), .first = 105 * ms}});
  check(out, standing(1.0), 0, 2000 * ms);
}

TEST(JointSilence, WhoEndsIsWaitedFor) {
  // A copy that a user ends, or one of two true programs: it may have been the driver. For as long
  // as it is remembered, or until one that was seen to move on its own beside it does.
  const Way late = starting_at(3000 * ms, 0.5), early = starting_at(500 * ms, 20.0);
  for (const Way& arm : {late, early}) {
    OneJoint joint;
    const auto out =
        joint.live({{.source = "second", .way = arm, .end = 1000 * ms},
                    {.source = "driver", .way = arm, .first = 5 * ms, .end = 14000 * ms}});
    const bool moved = arm(1000 * ms) > 0.0;
    EXPECT_EQ(check(out, arm, 1000 * ms, moved ? 1200 * ms : 10700 * ms).known, 0);
    const Frames frames = check(out, arm, moved ? 1600 * ms : 11100 * ms, 13900 * ms);
    EXPECT_EQ(frames.known, frames.all);
  }
}

TEST(JointSilence, WhoReturnsIsBelievedAgain) {
  // Of two true programs the one is away, then the other one for good.
  const Way arm = [](std::int64_t t) { return std::sin(2e-9 * static_cast<double>(t)); };
  const auto told = all_of({{.source = "a", .way = arm, .end = 9000 * ms},
                            {.source = "b", .way = arm, .first = 5 * ms, .end = 5000 * ms}});
  OneJoint joint;
  const auto out = joint.live(without(told, "a", 1500 * ms, 3500 * ms));
  check(out, arm, 0, 9000 * ms);
  for (const std::int64_t back : {2200 * ms, 5700 * ms}) {
    const Frames frames = check(out, arm, back, back + 1000 * ms);
    EXPECT_EQ(frames.known, frames.all) << back / ms;
  }
}

TEST(JointSilence, TwoTrueProgramsAreKnownWhileTheArmMoves) {
  const Way arm = [](std::int64_t t) { return std::sin(2e-9 * static_cast<double>(t)); };
  for (const std::int64_t period : {10 * ms, 33 * ms, 100 * ms}) {
    OneJoint joint;
    const auto out = joint.live(
        {{.source = "slow", .way = arm, .period = period, .end = 6000 * ms},
         {.source = "fast", .way = arm, .first = 5 * ms, .end = 6000 * ms, .latency = 3 * ms}});
    const Frames frames = check(out, arm, 300 * ms, 5800 * ms);
    EXPECT_EQ(frames.known, frames.all) << period / ms << " ms";
  }
}

TEST(JointSilence, AShortHistoryMakesNoValueBetweenTwoPrograms) {
  for (const double history : {0.0, 0.05, 0.15, 0.3}) {
    OneJoint joint("revolute", {.history = history});
    const auto out = joint.live(
        {{.source = "driver", .way = standing(1.0), .period = 125 * ms, .first = 20 * ms},
         {.source = "sliders", .way = standing(0.0), .first = 3 * ms}});
    EXPECT_EQ(check(out, standing(1.0), 250 * ms, 2000 * ms).known, 0);
  }
}

struct Pause {
  std::int64_t period, from, to;  // of the driver, ms
};

TEST(JointSilence, WithoutComparingAPauseDoesNotLoseTheFirstOne) {
  for (const auto& [period, from, to] : {Pause{10, 500, 760}, Pause{10, 40, 300}, Pause{250, 0, 0},
                                         Pause{500, 0, 0}, Pause{190, 0, 0}}) {
    std::vector<Told> told;
    tell({.source = "driver", .way = standing(1.0), .period = period * ms, .end = 6000 * ms}, told);
    std::erase_if(told, [&, from = from, to = to](const Told& each) {
      return each.stamp > from * ms && each.stamp < to * ms;
    });
    tell({.source = "sliders", .way = standing(0.0), .first = 55 * ms, .end = 6000 * ms}, told);
    OneJoint joint("revolute", {.compare_sources = false});
    const auto out = joint.live(std::move(told));
    const Frames after = check(out, standing(1.0), std::max<std::int64_t>(to, 100) * ms, 5800 * ms);
    EXPECT_GT(after.known, period > 200 ? 10 : 1000) << period;
  }
}

TEST(JointSilence, WithoutComparingWhoWasThereBeforeIsNotTakenForNew) {
  std::vector<Told> told;
  tell({.source = "driver", .way = standing(1.0), .end = 20000 * ms}, told);
  tell({.source = "driver", .way = standing(1.0), .first = 20600 * ms, .end = 22000 * ms}, told);
  tell({.source = "sliders", .way = standing(0.0), .first = 500 * ms, .end = 5000 * ms}, told);
  tell({.source = "sliders", .way = standing(0.0), .first = 20100 * ms, .end = 22000 * ms}, told);
  OneJoint joint("revolute", {.compare_sources = false});
  check(joint.live(std::move(told)), standing(1.0), 0, 22000 * ms);
}

}  // namespace
}  // namespace penumbra::test
