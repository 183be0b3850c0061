// SPDX-License-Identifier: Apache-2.0
// Late and early estimates: what is known depends on which came, not on when.
#include "../support/random.hpp"
#include "tracks.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

struct Given {
  PoseEstimate estimate;
  Verdict verdict = Verdict::visible;
};

/// Some 40 estimates in 0.9 s, with outliers, a jump to another place and refused verdicts.
std::vector<Given> eventful_track(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const Twisting truth{random_pose(random), 0.3 * normal<3>(random), normal<3>(random)};
  const double jump = 0.4 + uniform(random);
  std::vector<Given> all;
  for (double t = 0; t < 0.9; t += 0.005 + 0.04 * uniform(random)) {
    Given given;
    given.estimate.stamp = stamp_at(t);
    given.estimate.pose = moved(truth.at(t), sigmas(0.005, 0.03).cwiseProduct(normal<6>(random)));
    if (t > jump) given.estimate.pose.translation().z() += 2;
    if (uniform(random) < 0.15) given.estimate.pose.translation() += 3 * normal<3>(random);
    if (uniform(random) < 0.15) given.verdict = Verdict::partial;
    all.push_back(given);
  }
  return all;
}

PoseTracker fed(const std::vector<Given>& all) {
  PoseTracker tracker;
  for (const Given& given : all) tracker.update(given.estimate, given.verdict);
  return tracker;
}

void expect_same(const TrackedPose& a, const TrackedPose& b) {
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.age, b.age);
  EXPECT_EQ(a.pose.matrix(), b.pose.matrix());
  EXPECT_EQ(a.twist, b.twist);
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST(Order, AnyPermutationEndsAlikeToTheBit) {
  auto random = seeded_random(411);
  for (int run = 0; run < 30; ++run) {
    auto given = eventful_track(random);
    const PoseTracker sorted = fed(given);
    std::shuffle(given.begin(), given.end(), random);
    const PoseTracker shuffled = fed(given);
    for (double t = -0.1; t < 6; t += 0.013) {
      expect_same(sorted.at(stamp_at(t)), shuffled.at(stamp_at(t)));
    }
  }
}

PoseEstimate at_x(double seconds, double x) {
  PoseEstimate estimate;
  estimate.stamp = stamp_at(seconds);
  estimate.pose.translation().x() = x;
  return estimate;
}

TEST(Late, WithinTheMemoryIsTakenAndBeyondItNot) {
  PoseTracker tracker;
  tracker.update(at_x(0, 0), Verdict::visible);
  tracker.update(at_x(2, 0), Verdict::visible);
  EXPECT_EQ(tracker.update(at_x(1.0, 0), Verdict::visible), Outcome::accepted);
  PoseEstimate early = at_x(1.0, 0);
  --early.stamp;
  EXPECT_EQ(tracker.update(early, Verdict::visible), Outcome::refused_late);
  EXPECT_EQ(tracker.update(at_x(-1, 0), Verdict::visible), Outcome::refused_late);
}

TEST(Late, TheSameStampTwiceIsRefused) {
  PoseTracker tracker;
  for (int i = 0; i < 5; ++i) tracker.update(at_x(0.1 * i, 0), Verdict::visible);
  const auto before = tracker.at(stamp_at(0.4));
  EXPECT_EQ(tracker.update(at_x(0.4, 0.001), Verdict::visible), Outcome::refused_invalid);
  EXPECT_EQ(tracker.update(at_x(0.2, 0.001), Verdict::visible), Outcome::refused_invalid);
  expect_same(tracker.at(stamp_at(0.4)), before);
  EXPECT_EQ(tracker.update(at_x(0.5, 0.001), Verdict::hidden), Outcome::refused_verdict);
  EXPECT_EQ(tracker.update(at_x(0.5, 0.001), Verdict::visible), Outcome::accepted);
}

TEST(Memory, ThePastIsAnsweredWithinIt) {
  PoseTracker tracker;
  for (int i = 0; i <= 100; ++i) tracker.update(at_x(0.1 * i, 0.02 * i), Verdict::visible);
  const auto past = tracker.at(stamp_at(9.35));
  EXPECT_EQ(past.source, Source::predicted);
  EXPECT_NEAR(past.age, 0.05, 1e-9);
  EXPECT_NEAR(past.pose.translation().x(), 0.2 * 9.35, 1e-3);
  EXPECT_EQ(tracker.at(stamp_at(9.3)).source, Source::measured);
  EXPECT_EQ(tracker.at(stamp_at(5)).source, Source::lost);
  EXPECT_TRUE(std::isinf(tracker.at(stamp_at(5)).age));
}

}  // namespace
}  // namespace penumbra::test
