// SPDX-License-Identifier: Apache-2.0
// Programs that tell one joint's random ways at random rates, late, out of order, with losses:
// those that tell the truth are never disputed, those that tell something else always are.
#include "../support/random.hpp"
#include "../support/run_length.hpp"
#include "told_sources.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr std::int64_t length = 3000 * ms;
constexpr double fastest = 3.0;     // rad/s, as arms are
constexpr double strongest = 40.0;  // rad/s^2

/// What a driver and a program that sends it on may be late by, beside the driver's period.
constexpr std::int64_t longest_relay = 15 * ms;

/// How late a message is heard at the most.
constexpr std::int64_t longest_way = 60 * ms;

/// Noise of the states, and the tolerance where the arm comes to the sliders' pose, rad.
constexpr double largest_error = 0.004 + JointRule::turn_noise;

/// What the way bends between two states of a driver, two of its longest periods apart as one is
/// lost, and where a relay was that nobody knows for one yet, rad.
constexpr double largest_bend = largest_error + strongest * 0.21 * 0.21 / 8.0;

/// By then it is known of two programs how they came where they are: two times of 105 ms between
/// states, half as many again lost, and 0.2 s around what was not certain.
constexpr std::int64_t first_certain = 650 * ms;

class Draw {
 public:
  explicit Draw(std::mt19937_64& random) : random_(random) {}
  double number(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  std::int64_t time(std::int64_t from, std::int64_t to) {
    return std::uniform_int_distribution<std::int64_t>(from, to)(random_);
  }
  bool chance(double share) { return std::bernoulli_distribution(share)(random_); }

  /// Swings of several frequencies, with rests.
  Way way() {
    struct Swing {
      double size, frequency, phase;
    };
    std::vector<Swing> swings;
    for (int i = 0; i < 3; ++i) {
      const double frequency = number(0.3, 12.0);  // rad/s
      const double size = std::min(fastest / frequency, strongest / (frequency * frequency)) / 3.0;
      swings.push_back({number(0.2, 1.0) * size, frequency, number(0.0, 6.28)});
    }
    const double middle = number(-2.0, 2.0);
    const std::int64_t rest = time(0, length), rested = rest + time(0, 1000 * ms);
    return [=](std::int64_t t) {
      // It stands from `rest` on, and goes on from there.
      const std::int64_t shown = t < rest ? t : std::max(rest, t - (rested - rest));
      double at = middle;
      for (const Swing& swing : swings)
        at += swing.size *
              std::sin(swing.frequency * 1e-9 * static_cast<double>(shown) + swing.phase);
      return at;
    };
  }

  std::int64_t period() { return time(2, 100) * ms; }

  /// What becomes of a program's messages on their way.
  std::vector<Told> sent(const Program& program, double most_lost = 0.1, double noise = 0.004) {
    std::vector<Told> told;
    const std::int64_t latency = time(0, longest_way / 2), scatter = time(0, longest_way / 2);
    const double lost = chance(0.5) ? 0.0 : most_lost;
    for (std::int64_t at = program.first; at < program.end; at += program.period) {
      if (chance(lost)) continue;
      const std::int64_t stamp = at + time(0, program.period / 20);
      told.push_back({stamp + latency + time(0, scatter), stamp,
                      program.way(stamp) + number(-noise, noise), program.source});
    }
    return told;
  }

 private:
  std::mt19937_64& random_;
};

/// What had been told last `late` before.
Way sent_on(const std::vector<Told>& told, std::int64_t late) {
  return [told, late](std::int64_t t) {
    const auto next = std::find_if(told.begin() + 1, told.end(),
                                   [&](const Told& each) { return each.stamp + late > t; });
    return std::prev(next)->value;
  };
}

void append(std::vector<Told>& all, const std::vector<Told>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

TEST(JointSourcesProperty, TruthIsNeverDisputed) {
  std::mt19937_64 random = seeded_random(21);
  Draw draw(random);
  std::int64_t known = 0, asked = 0;
  double worst = 0.0;
  for (int round = 0; round < samples(300); ++round) {
    const Way way = draw.way();
    const Program driver{.source = "driver", .way = way, .period = draw.period(), .end = length};
    const Program second{.source = "second", .way = way, .period = draw.period(), .end = length};
    std::vector<Told> told = draw.sent(driver);
    std::vector<Told> other = draw.sent(second);
    if (draw.chance(0.5)) {
      const Way heard = sent_on(told, draw.time(0, longest_relay));
      const Program relay{.source = "relay", .way = heard, .period = second.period, .end = length};
      other = draw.sent(relay, 0.1, 0.0);
      for (Told& each : other) each.arrival += longest_way;  // after what it sends on
    }
    append(told, other);
    OneJoint joint;
    joint.hear(std::move(told));
    ASSERT_EQ(joint.count(JointStatus::disputed, first_certain, length), 0)
        << "round " << round << ", periods " << driver.period / ms << " and " << second.period / ms
        << " ms";
    for (std::int64_t stamp = first_certain; stamp < length - 400 * ms; stamp += ms) {
      const JointAnswer& answer = joint.at(stamp);
      if (answer.status != JointStatus::ok) continue;
      ++known;
      worst = std::max(worst, std::abs(answer.positions[0] - way(stamp)));
    }
    asked += (length - 400 * ms - first_certain) / ms;
  }
  std::cout << known << " of " << asked << " known, to " << worst << " rad\n";
  EXPECT_LT(worst, largest_bend);
  EXPECT_GT(known, asked / 10 * 8);
}

TEST(JointSourcesProperty, WhatIsAnotherPoseAlwaysIs) {
  std::mt19937_64 random = seeded_random(22);
  Draw draw(random);
  for (int round = 0; round < samples(300); ++round) {
    const Way way = draw.way();
    const Program driver{.source = "driver", .way = way, .period = draw.period(), .end = length};
    // Sliders that the arm comes near, but never to: as far as it gets in the time of two of the
    // slower one's states.
    double most = -10.0;
    for (std::int64_t t = 0; t < length; t += ms) most = std::max(most, way(t));
    Program other{.source = "other", .way = standing(most), .period = draw.period(), .end = length};
    const double reach =
        1e-9 * static_cast<double>(4 * std::max(driver.period, other.period) + 60 * ms);
    const double apart = 0.05 + fastest * reach;
    if (draw.chance(0.5)) {
      other.way = standing(most + apart);
    } else {  // or that do what it does, elsewhere
      other.way = [&](std::int64_t t) { return way(t) + 2.0 * apart; };
    }
    OneJoint joint;
    std::vector<Told> told = draw.sent(driver, 0.0);
    append(told, draw.sent(other, 0.0));
    joint.hear(std::move(told));
    ASSERT_EQ(joint.count(JointStatus::ok, 400 * ms, length - 400 * ms), 0)
        << "round " << round << ", periods " << driver.period / ms << " and " << other.period / ms
        << " ms";
  }
}

TEST(JointSourcesProperty, NoPoseIsTakenFromBetweenThem) {
  // Sliders at rest while the arm goes through their pose: what is not disputed is the arm's pose,
  // but for what the tolerance allows.
  std::mt19937_64 random = seeded_random(23);
  Draw draw(random);
  double worst = 0.0;
  for (int round = 0; round < samples(300); ++round) {
    const Way way = draw.way();
    const Program driver{
        .source = "driver", .way = way, .period = draw.time(2, 20) * ms, .end = length};
    const Program sliders{.source = "sliders",
                          .way = standing(way(draw.time(0, length))),
                          .period = draw.period(),
                          .end = length};
    OneJoint joint;
    std::vector<Told> told = draw.sent(driver);
    append(told, draw.sent(sliders));
    for (const auto& [stamp, status, value] : joint.live(std::move(told)))
      if (stamp >= 400 * ms && status == JointStatus::ok)
        worst = std::max(worst, std::abs(value - way(stamp)));
    for (std::int64_t stamp = 400 * ms; stamp < length - 400 * ms; stamp += ms)
      if (joint.at(stamp).status == JointStatus::ok)
        worst = std::max(worst, std::abs(joint.at(stamp).positions[0] - way(stamp)));
  }
  std::cout << "at most " << worst << " rad\n";
  EXPECT_LT(worst, largest_error);
}

}  // namespace
}  // namespace penumbra::test
