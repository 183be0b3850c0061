// SPDX-License-Identifier: Apache-2.0
// A program that sends on what another one tells: it is seen to, and never answers. One that runs
// ahead of the driver is no driver, and makes no copy of it. Asked as frames are.
#include "../support/random.hpp"
#include "told_sources.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <penumbra/robot/track_ways.hpp>

namespace penumbra::test {
namespace {

// Of a driver's own track beside the swing between two of its states.
constexpr double of_copied_driver = 1e-3;

// Two new values of a copy that tells each 100 ms, and the way to the first one.
constexpr std::int64_t recognised = 500 * ms;

/// At most 1.26 rad/s, with no symmetry that makes two times alike.
double swing(std::int64_t t) {
  const double s = 1e-9 * static_cast<double>(t);
  return 0.6 * std::sin(1.57 * s) + 0.1 * std::sin(2.9 * s);
}

Program driver_of(std::int64_t period = 10 * ms) {
  return {.source = "driver", .way = swing, .period = period, .end = 9000 * ms, .latency = 3 * ms};
}

Program copier(const Program& driver, std::int64_t late, std::int64_t period = 10 * ms) {
  return {.source = "copy",
          .way = copy_of(driver, late),
          .period = period,
          .first = 5 * ms,
          .end = 9000 * ms};
}

TEST(JointCopies, WhoRunsAheadIsNotTheDriver) {
  // Commands, and a copy whose clock is behind: what is known is what both tell.
  for (const std::int64_t ahead : {20 * ms, 50 * ms, 100 * ms}) {
    const Program driver = driver_of();
    const Way commanded = [=](std::int64_t t) { return swing(t + ahead); };
    Program behind = copier(driver, 2 * ms);
    behind.way = [=, copy = behind.way](std::int64_t t) { return copy(t + ahead); };
    behind.latency = ahead + ms;
    for (const Program& other :
         {Program{.source = "commands", .way = commanded, .first = 5 * ms, .end = 9000 * ms},
          behind}) {
      OneJoint joint;
      const Frames frames = check(joint.live({driver, other}), swing, recognised, 8800 * ms);
      EXPECT_LT(frames.known, frames.all * 7 / 10) << "where it is slow, " << ahead / ms;
    }
  }
}

TEST(JointCopies, SlidersThatBeginAreNotTheDriverWhoseMessagesAreLate) {
  for (const std::int64_t latency : {150 * ms, 230 * ms, 400 * ms}) {
    Program driver = driver_of();
    driver.latency = latency;
    const auto out = OneJoint().live(
        {driver,
         {.source = "sliders", .way = standing(0.3), .first = 2000 * ms, .end = 9000 * ms}});
    check(out, swing, 0, 9000 * ms);
  }
}

TEST(JointCopies, TheDriverIsKnownOnceWhoRanAheadIsForgotten) {
  Program driver = driver_of();
  driver.end = 25000 * ms;
  const Way commanded = [](std::int64_t t) { return swing(t + 60 * ms); };
  OneJoint joint;
  const auto out = joint.live(
      {driver, {.source = "commands", .way = commanded, .first = 5 * ms, .end = 9000 * ms}});
  const Frames frames = check(out, swing, 10500 * ms, 24800 * ms, of_copied_driver);
  EXPECT_EQ(frames.known, frames.all) << "as it moved on its own beside it, and since";
}

TEST(JointCopies, NoneIsTooLateToBeSeen) {
  for (const std::int64_t late : {2 * ms, 40 * ms, 450 * ms, 1500 * ms})
    for (const std::int64_t period : {10 * ms, 100 * ms}) {
      const Program driver = driver_of(20 * ms);
      const auto out = OneJoint().live({driver, copier(driver, late, period)});
      // A contradiction that was seen before holds for 0.8 s.
      const Frames frames =
          check(out, swing, recognised + late + 800 * ms, 8800 * ms, of_copied_driver);
      EXPECT_EQ(frames.known, frames.all) << late / ms << " ms, each " << period / ms;
    }
}

TEST(JointCopies, OfACopyToo) {
  const Program driver = driver_of();
  Program first = copier(driver, 4 * ms, 20 * ms);
  Program second = copier(first, 4 * ms, 50 * ms);
  second.source = "copy's copy", second.first = 45 * ms;
  const Frames frames = check(OneJoint().live({driver, first, second}), swing, recognised,
                              8800 * ms, of_copied_driver);
  EXPECT_EQ(frames.known, frames.all);
}

TEST(JointCopies, ALateOneIsNotTheDriverThatDies) {
  for (const std::int64_t late : {100 * ms, 450 * ms, 600 * ms, 900 * ms})
    for (const double speed : {0.2, 1.0}) {
      Program driver = driver_of();
      driver.way = moving_on(speed), driver.end = 4000 * ms;
      const auto out = OneJoint().live({driver, copier(driver, late)});
      EXPECT_EQ(check(out, driver.way, 4000 * ms, 9000 * ms).known, 0) << late / ms << " ms";
    }
}

TEST(JointCopies, OneThatIsUnheardWhenTheDriverDiesIsNotTheDriver) {
  for (const std::int64_t again : {300 * ms, 410 * ms, 800 * ms})
    for (const std::int64_t start : {500 * ms, 3700 * ms}) {  // it is known to be a copy, or not
      Program driver = driver_of();
      driver.way = starting_at(start, 100.0), driver.end = 4000 * ms;
      const auto told =
          without(all_of({driver, copier(driver, 4 * ms)}), "copy", 3700 * ms, 4000 * ms + again);
      EXPECT_EQ(check(OneJoint().live(told), driver.way, 4000 * ms, 9000 * ms).known, 0);
    }
}

TEST(JointCopies, DoNotAnswerWhileTheyAloneHearTheDriver) {
  for (const std::int64_t late : {4 * ms, 40 * ms})
    for (const std::int64_t lost : {300 * ms, 2000 * ms})
      for (const std::int64_t start : {0 * ms, 3000 * ms}) {  // known to be copies, or not yet
        Program driver = driver_of();
        driver.way = [=](std::int64_t t) { return swing(std::max<std::int64_t>(0, t - start)); };
        const auto told =
            without(all_of({driver, copier(driver, late)}), "driver", 3000 * ms, 3000 * ms + lost);
        const auto out = OneJoint().live(told);
        check(out, driver.way, recognised, 9000 * ms, start == 0 ? of_copied_driver : tolerance);
        const Frames since = check(out, driver.way, 3900 * ms + lost, 8800 * ms);
        EXPECT_EQ(since.known, since.all) << "it is back";
      }
}

TEST(JointCopies, AnswerOnceTheDriverIsForgotten) {
  // A relay that is all that is heard any more.
  Program driver = driver_of();
  driver.end = 30000 * ms;
  Program relay = copier(driver, 0);
  relay.end = 30000 * ms;
  const auto out =
      OneJoint().live(without(all_of({driver, relay}), "driver", 5000 * ms, 30000 * ms));
  EXPECT_EQ(check(out, swing, 5005 * ms, 14700 * ms).known, 0);
  const Frames frames = check(out, swing, 17000 * ms, 29800 * ms, 0.02);  // as late as it is
  EXPECT_EQ(frames.known, frames.all);
}

TEST(JointCopies, ADriverThatTellsTheSameAgainIsNone) {
  // A recording that is played in a loop by one program, and sent on by another.
  for (const std::int64_t loop : {1000 * ms, 2000 * ms, 3990 * ms}) {
    Program driver = driver_of();
    driver.way = [=](std::int64_t t) {
      const std::int64_t along = t % loop;
      return swing(2000 * ms + std::min(along, loop - along));
    };
    const auto out = OneJoint().live({driver, copier(driver, 15 * ms)});
    const Frames frames = check(out, driver.way, recognised, 8800 * ms, tolerance);
    EXPECT_EQ(frames.known, frames.all) << loop / ms;
  }
}

/// A number of ticks of an encoder with so many of them a turn, to a float's digits as drivers of
/// servos tell it.
Way read(const Way& way, double ticks) {
  const double tick = 2.0 * std::numbers::pi / ticks;
  return [=](std::int64_t t) {
    return static_cast<double>(static_cast<float>(std::round(way(t) / tick) * tick));
  };
}

TEST(JointCopies, CommandsInTheTicksOfTheEncoderAreNotTheDriver) {
  // All numbers of the driver were commanded before. Far from 0 a float has fewer digits.
  const Way quick = [](std::int64_t t) { return 3.0 + 2.0 * swing(t); };
  for (const double ticks : {4096.0, 360.0})
    for (const std::int64_t ahead : {30 * ms, 60 * ms, 250 * ms})
      for (const std::int64_t period : {2 * ms, 10 * ms, 20 * ms}) {
        Program driver = driver_of();
        driver.way = read(quick, ticks);
        const Way commanded = [=](std::int64_t t) { return driver.way(t + ahead); };
        const Program commands{.source = "commands",
                               .way = commanded,
                               .period = period,
                               .first = 5 * ms,
                               .end = 9000 * ms};
        check(OneJoint().live({driver, commands}), quick, recognised, 8800 * ms,
              tolerance + 2.0 * std::numbers::pi / ticks);
      }
}

struct Turns {
  double distance(double a, double b) const { return std::abs(a - b); }
};

TEST(JointCopies, NumbersOfAGridProveNothing) {
  // Random ways in a float's ticks, up to 200 between two states: no told one proves anything where
  // a third of those about it are told, too. Of ways on no grid nearly all do, however few.
  std::mt19937_64 random = seeded_random(24);
  const auto draw = [&](int to) { return std::uniform_int_distribution<int>(0, to)(random); };
  constexpr double tick = 2.0 * std::numbers::pi / 4096.0, near = 1e-6;
  constexpr int about = 8, states = 100;
  const Turns rule;
  int dense = 0, told = 0, all = 0;
  for (int round = 0; round < 3000; ++round) {
    StampedTrack<double> ticks, free;
    double at = 2000.0, angle = 1.0, speed = 0.4, way = 1.0;
    const int longest = 2 + draw(round % 2 == 0 ? 10 : 198), kept = 4 + draw(states - 4);
    for (int i = 0; i < states; ++i) {
      if (draw(29) == 0) way = -way;
      at += way * draw(longest);
      ticks.put({i, static_cast<double>(static_cast<float>(at * tick))});
      speed += 0.1 * std::uniform_real_distribution<double>(-1.0, 1.0)(random);
      angle += 0.1 * speed;
      if (i < kept) free.put({i, angle});
    }
    const double value = ticks.states()[static_cast<std::size_t>(draw(states - 1))].value;
    int hit = 0;
    for (int i = -about; i <= about; ++i) {
      const auto is_there = [&](const auto& s) {
        return rule.distance(s.value, value + i * tick) < near;
      };
      hit += std::ranges::any_of(ticks.states(), is_there) ? 1 : 0;
    }
    if (3 * hit >= 2 * about + 1) {
      ++dense;
      EXPECT_FALSE(is_telling(rule, ticks, 0, states, value)) << round;
    }
    ++all;
    told += is_telling(rule, free, 0, states, free.states().back().value) ? 1 : 0;
  }
  EXPECT_GT(dense, 300);
  EXPECT_GT(told, all * 9 / 10);
}

TEST(JointCopies, OneOtherValueProvesNothing) {
  // Of what is told once or twice nobody knows the grid.
  StampedTrack<double> track;
  track.put({0, 1.0});
  EXPECT_FALSE(is_telling(Turns(), track, 0, 9, 1.0));
  track.put({1, 1.5});
  EXPECT_FALSE(is_telling(Turns(), track, 0, 9, 1.0));
}

/// Of where a tool is that one joint turns, as TF tells it without the links between.
struct Chords {
  double distance(double a, double b) const { return 1.6 * std::abs(std::sin(0.5 * (a - b))); }
};

TEST(JointCopies, TicksOfAJointFarFromTheToolProveNothing) {
  // Chords of ticks are no multiples of one, but those of one tick are alike.
  for (const double ticks : {4096.0, 360.0}) {
    const double tick = 2.0 * std::numbers::pi / ticks;
    StampedTrack<double> track;
    for (int i = 0; i < 100; ++i) track.put({i, tick * (i < 60 ? i : 120 - i)});
    for (int i = 0; i < 60; ++i)
      EXPECT_FALSE(is_telling(Chords(), track, 0, 100, i * tick)) << ticks << " " << i;
  }
}

TEST(JointCopies, TwoThatReadOneEncoderAreKnown) {
  // Both tell the same numbers, now the one first and now the other, or the quick one always.
  for (const std::int64_t period : {2 * ms, 10 * ms, 13 * ms, 50 * ms}) {
    const Way ticks = read(swing, 4096.0);
    const auto out = OneJoint().live(
        {{.source = "a", .way = ticks, .end = 9000 * ms},
         {.source = "b", .way = ticks, .period = period, .first = 4 * ms, .end = 5000 * ms}});
    const Frames both = check(out, swing, recognised, 4800 * ms);
    EXPECT_GT(both.known, both.all * 99 / 100) << period / ms;
    const Frames one = check(out, swing, 6500 * ms, 8800 * ms);
    EXPECT_EQ(one.known, one.all) << period / ms << ", since the other one ended";
  }
}

}  // namespace
}  // namespace penumbra::test
