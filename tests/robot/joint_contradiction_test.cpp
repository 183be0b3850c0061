// SPDX-License-Identifier: Apache-2.0
// Joint states of two programs that know of different poses, and of one whose joints move fast.
#include "../support/random.hpp"
#include "urdf_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <penumbra/robot/joint_buffer.hpp>

namespace penumbra::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::int64_t second = 1'000'000'000;
const std::vector<std::string> names = {"p", "q"};

/// Some metres and radians, with some 20 rad/s^2: quick for an arm.
double moving(std::int64_t stamp) {
  return 0.5 * std::sin(2.0 * pi * static_cast<double>(stamp) / second);
}

class JointContradiction : public testing::Test {
 protected:
  void add(std::int64_t stamp, double value) {
    buffer_.insert(stamp, names, std::vector<double>{value, value});
  }
  const JointAnswer& at(std::int64_t stamp) {
    buffer_.at(stamp, answer_);
    return answer_;
  }

  const Robot robot_ = arm();
  JointBuffer buffer_{robot_};
  JointAnswer answer_;
};

/// joint_state_publisher beside a driver: zeros, at any rate, in any order of coming.
TEST_F(JointContradiction, OfASecondPublisherIsNeverTakenForThePose) {
  std::mt19937_64 random = seeded_random(61);
  for (const double rate : {2.0, 10.0, 50.0, 125.0, 300.0}) {
    buffer_.clear();
    std::vector<std::pair<std::int64_t, double>> states;
    for (std::int64_t stamp = second; stamp < 3 * second; stamp += second / 125)
      states.emplace_back(stamp, 1.0 + moving(stamp));
    const auto period = static_cast<std::int64_t>(second / rate);
    for (std::int64_t stamp = second + period / 3; stamp < 3 * second; stamp += period)
      states.emplace_back(stamp, 0.0);
    std::shuffle(states.begin(), states.end(), random);
    for (const auto& [stamp, value] : states) add(stamp, value);
    int known = 0, contradictory = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto stamp = static_cast<std::int64_t>(
          std::uniform_real_distribution<double>(1.05, 2.95)(random) * second);
      const JointAnswer& answer = at(stamp);
      known += answer.status == JointStatus::ok ? 1 : 0;
      contradictory += answer.status == JointStatus::contradictory ? 1 : 0;
      if (answer.status != JointStatus::ok) continue;
      constexpr double jitter = 0.03;  // that is believed
      ASSERT_NEAR(answer.positions[1], 1.0 + moving(stamp), jitter) << rate << " Hz, " << stamp;
    }
    EXPECT_EQ(known + contradictory, 2000);
    EXPECT_GT(contradictory, 0) << rate << " Hz";
    if (rate < 20.0) {
      EXPECT_GT(known, 1000) << rate << " Hz: away from its states the driver's are known";
    }
  }
}

/// As it is live: the newest state is the first one after the stamp.
TEST_F(JointContradiction, IsSeenInTheNewestState) {
  for (int i = 0; i < 10; ++i) add(second + i * second / 100, 1.0);
  EXPECT_EQ(at(second + 9 * second / 100 - 1).status, JointStatus::ok);
  add(second + second / 10, 0.0);
  for (const std::int64_t before : {second / 200, std::int64_t{0}}) {
    EXPECT_EQ(at(second + second / 10 - before).status, JointStatus::contradictory) << before;
    ASSERT_EQ(answer_.gaps.size(), 2U);
    EXPECT_EQ(answer_.gaps[0].why, JointStatus::contradictory);
  }
  EXPECT_EQ(at(second + second / 20).status, JointStatus::ok) << "of before";
}

/// The quickest joints, states at 20 to 1000 Hz, stamped 2 ms off, some lost.
TEST_F(JointContradiction, IsNoneOfAQuickJoint) {
  std::mt19937_64 random = seeded_random(62);
  std::normal_distribution<double> noise(0.0, 1e-3);
  std::uniform_real_distribution<double> jitter(-0.002, 0.002), share(0.0, 1.0);
  for (const double rate : {20.0, 100.0, 500.0, 1000.0}) {
    buffer_.clear();
    for (double t = 1.0; t < 3.0; t += 1.0 / rate) {
      const double moved = 0.4 * std::sin(10.0 * t);  // to 40 rad/s^2 and 4 rad/s
      if (share(random) < 0.9)
        buffer_.insert(static_cast<std::int64_t>((t + jitter(random)) * second), names,
                       std::vector<double>{0.0, moved + noise(random)});
    }
    for (double t = 1.2; t < 2.8; t += 0.0007)
      ASSERT_NE(at(static_cast<std::int64_t>(t * second)).status, JointStatus::contradictory)
          << rate << " Hz, " << t;
  }
}

TEST_F(JointContradiction, IsNoneWhereAContinuousJointTurnsOver) {
  const Robot continuous = arm("continuous");
  JointBuffer buffer(continuous);
  for (int i = 0; i < 100; ++i)
    buffer.insert(second + i * second / 100, names,
                  std::vector<double>{0.0, std::remainder(3.0 + 0.01 * i, 2.0 * pi)});
  for (int i = 1; i < 198; ++i) {
    buffer.at(second + i * second / 200, answer_);
    ASSERT_EQ(answer_.status, JointStatus::ok) << i;
  }
}

TEST_F(JointContradiction, CanBeLeftOut) {
  JointBuffer buffer(robot_, {.max_acceleration = std::numeric_limits<double>::infinity()});
  for (int i = 0; i < 10; ++i)
    buffer.insert(second + i * second / 100, names, std::vector<double>(2, i % 2));
  buffer.at(second + second / 40, answer_);
  EXPECT_EQ(answer_.status, JointStatus::ok);
}

}  // namespace
}  // namespace penumbra::test
