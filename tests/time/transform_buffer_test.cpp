// SPDX-License-Identifier: Apache-2.0
#include "../robot/urdf_text.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <penumbra/time/transform_buffer.hpp>

namespace penumbra::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kTolerance = 1e-12;  // lengths of 1, a handful of operations

Eigen::Isometry3d shift(double x, double y = 0.0, double z = 0.0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

Eigen::Isometry3d turn_z(double angle) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

class Transforms : public testing::Test {
 protected:
  const TransformAnswer& at(std::int64_t stamp, const char* target, const char* source) {
    buffer_.at(stamp, target, source, answer_);
    EXPECT_EQ(answer_.message.empty(), answer_.status == TransformStatus::ok);
    EXPECT_EQ(answer_.message.find('\n'), std::string::npos);
    return answer_;
  }

  void expect_refused(TransformInsert outcome, TransformInsert why, const std::string& names) {
    EXPECT_EQ(outcome, why);
    EXPECT_TRUE(holds(buffer_.last_refusal(), names));
  }

  TransformBuffer buffer_{{.max_gap = 0.1, .history = 1.0}};
  TransformAnswer answer_;
};

TEST_F(Transforms, WhatIsMissingIsNamed) {
  buffer_.insert_static("base", "arm", shift(1));
  buffer_.insert_static("world", "camera", shift(1));
  EXPECT_EQ(at(1, "base", "camera").status, TransformStatus::missing);
  EXPECT_TRUE(holds(answer_.message, "'camera'"));
  EXPECT_TRUE(holds(answer_.message, "'world'"));
  EXPECT_TRUE(holds(answer_.message, "'base'"));
  EXPECT_EQ(at(1, "base", "hand").status, TransformStatus::missing);
  EXPECT_TRUE(holds(answer_.message, "'hand' was never seen"));
  EXPECT_FALSE(buffer_.complete_until("base", "hand"));
}

TEST_F(Transforms, CompleteUntilTheLeastOfThoseThatMove) {
  buffer_.insert_static("base", "a", shift(1));
  EXPECT_EQ(buffer_.complete_until("base", "a"), std::numeric_limits<std::int64_t>::max());
  buffer_.insert(5, "a", "b", shift(1));
  buffer_.insert(9, "b", "c", shift(1));
  EXPECT_EQ(buffer_.complete_until("base", "c"), 5);
  EXPECT_EQ(buffer_.complete_until("b", "c"), 9);
  EXPECT_EQ(buffer_.newest_of("c"), 9);
  EXPECT_FALSE(buffer_.newest_of("a"));
  EXPECT_FALSE(buffer_.newest_of("d"));
}

TEST_F(Transforms, WhatIsNoTreeIsRefusedAndChangesNothing) {
  buffer_.insert(1, "a", "b", shift(1));
  buffer_.insert_static("b", "c", shift(1));
  expect_refused(buffer_.insert(2, "c", "a", shift(5)), TransformInsert::loop, "'a' in 'c'");
  expect_refused(buffer_.insert(2, "c", "c", shift(5)), TransformInsert::loop, "'c' in 'c'");
  expect_refused(buffer_.insert(2, "d", "b", shift(5)), TransformInsert::second_parent, "'a'");
  expect_refused(buffer_.insert_static("a", "b", shift(5)), TransformInsert::static_and_free,
                 "moving before");
  expect_refused(buffer_.insert(2, "b", "c", shift(5)), TransformInsert::static_and_free,
                 "static before");
  EXPECT_EQ(buffer_.refused(), 5U);
  EXPECT_EQ(buffer_.count(TransformInsert::loop), 2U);
  EXPECT_EQ(buffer_.count(TransformInsert::taken), 2U);
  EXPECT_FALSE(buffer_.knows("d"));
  EXPECT_TRUE(at(1, "a", "c").T_target_source.isApprox(shift(2), kTolerance));
  EXPECT_EQ(at(2, "a", "b").status, TransformStatus::stale);
}

TEST_F(Transforms, WhatIsNoTransformIsRefused) {
  Eigen::Isometry3d bad = shift(std::nan(""));
  expect_refused(buffer_.insert(1, "a", "b", bad), TransformInsert::not_rigid, "'b' in 'a'");
  bad = shift(1);
  bad.linear() *= 1.001;
  EXPECT_EQ(buffer_.insert_static("a", "b", bad), TransformInsert::not_rigid);
  bad.linear() = Eigen::Vector3d(1, 1, -1).asDiagonal();
  EXPECT_EQ(buffer_.insert(1, "a", "b", bad), TransformInsert::not_rigid);
  EXPECT_EQ(buffer_.insert(1, "a", "b", shift(1.1e9)), TransformInsert::not_rigid);
  EXPECT_EQ(buffer_.insert(0, "a", "b", shift(1)), TransformInsert::no_stamp);
  EXPECT_EQ(buffer_.insert(-5, "a", "b", shift(1)), TransformInsert::no_stamp);
  EXPECT_EQ(buffer_.insert(1, "", "b", shift(1)), TransformInsert::bad_name);
  EXPECT_EQ(buffer_.insert(1, "a", "/", shift(1)), TransformInsert::bad_name);
  EXPECT_EQ(buffer_.insert(1, "a", std::string(257, 'b'), shift(1)), TransformInsert::bad_name);
  EXPECT_FALSE(buffer_.knows("a"));
  EXPECT_EQ(buffer_.refused(), 9U);
}

TEST(TransformLimits, StatesAreBoundedInNumberAndTime) {
  TransformBuffer buffer({.max_gap = 1.0, .history = 1e-6, .max_states = 10});
  for (std::int64_t stamp = 1; stamp <= 1000; ++stamp)
    buffer.insert(stamp, "a", "b", shift(static_cast<double>(stamp)));
  TransformAnswer answer;
  buffer.at(991, "a", "b", answer);
  EXPECT_EQ(answer.status, TransformStatus::ok);
  buffer.at(990, "a", "b", answer);
  EXPECT_EQ(answer.status, TransformStatus::stale);
  buffer.insert(9000, "a", "b", shift(0));
  buffer.insert(9001, "c", "d", shift(0));
  buffer.at(999, "a", "b", answer);
  EXPECT_EQ(answer.status, TransformStatus::stale) << "older than the history";
  buffer.at(9000, "a", "b", answer);
  EXPECT_EQ(answer.status, TransformStatus::ok);
}

TEST_F(Transforms, ClearForgetsWhatMovesAndKeepsWhatIsStatic) {
  buffer_.insert(5, "a", "b", shift(1));
  buffer_.insert_static("b", "c", shift(1));
  buffer_.insert(5, "b", "b", shift(1));
  buffer_.clear();
  EXPECT_EQ(at(5, "a", "b").status, TransformStatus::missing);
  EXPECT_EQ(at(5, "b", "c").status, TransformStatus::ok);
  EXPECT_EQ(buffer_.refused(), 1U);
  EXPECT_EQ(buffer_.insert(5, "z", "b", shift(1)), TransformInsert::taken) << "another parent";
}

TEST_F(Transforms, TwoPublishersOfOneFrameThatDifferAreDisputed) {
  for (std::int64_t t = 100; t < 500; t += 10) {
    buffer_.insert(t * kMs, "base", "arm", shift(0.5), "publisher 1 of /tf");
    buffer_.insert((t + 3) * kMs, "base", "arm", turn_z(0.03), "publisher 2 of /tf");
    buffer_.insert(t * kMs, "arm", "tool", shift(0.1), "publisher 1 of /tf");
  }
  EXPECT_EQ(at(305 * kMs, "base", "tool").status, TransformStatus::disputed);
  for (const char* const part :
       {"'arm' in 'base'", "500 mm apart", "publisher 1 of /tf and by", "publisher 2 of /tf"})
    EXPECT_TRUE(holds(answer_.message, part));
  EXPECT_EQ(at(305 * kMs, "arm", "tool").status, TransformStatus::ok) << "it is not in this chain";
}

TEST_F(Transforms, TwoPosesOfOneStampAreDisputedAsABagDoesNotSayWhose) {
  for (std::int64_t t = 100; t < 500; t += 10) {
    buffer_.insert(t * kMs, "base", "arm", shift(0.5), "/tf");
    if (t < 250 || t > 350) buffer_.insert(t * kMs, "base", "arm", shift(0.5), "/tf");
    if (t >= 250 && t <= 350) buffer_.insert(t * kMs, "base", "arm", shift(0.6), "/tf");
  }
  EXPECT_EQ(at(145 * kMs, "base", "arm").status, TransformStatus::ok) << "a frame published twice";
  EXPECT_EQ(at(303 * kMs, "base", "arm").status, TransformStatus::disputed);
  EXPECT_TRUE(holds(answer_.message, "100 mm apart, at 300000000 ns by /tf"));
}

}  // namespace
}  // namespace penumbra::test
