// SPDX-License-Identifier: Apache-2.0
// Late and early estimates: what is known depends on which came, not on when.
#include "../support/allocations.hpp"
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

TEST(Order, ALongTrackWithLatenciesToo) {
  auto random = seeded_random(412);
  std::uniform_real_distribution<double> latency(0, 0.9);
  std::vector<Given> given;
  std::vector<std::pair<double, std::size_t>> arrivals;
  Twisting truth{random_pose(random), {0.1, 0.2, 0}, {0, 0, 0.4}};
  for (std::size_t i = 0; i < 600; ++i) {
    const double t = static_cast<double>(i) / 30;
    Given one;
    one.estimate.stamp = stamp_at(t);
    one.estimate.pose = moved(truth.at(t), sigmas(0.005, 0.03).cwiseProduct(normal<6>(random)));
    given.push_back(one);
    arrivals.emplace_back(t + latency(random), i);
  }
  std::sort(arrivals.begin(), arrivals.end());
  PoseTracker late;
  for (const auto& arrival : arrivals) {
    const Given& one = given[arrival.second];
    EXPECT_NE(late.update(one.estimate, one.verdict), Outcome::refused_late);
  }
  const PoseTracker sorted = fed(given);
  for (double t = 19; t < 22; t += 0.1) expect_same(sorted.at(stamp_at(t)), late.at(stamp_at(t)));
}

TEST(Order, PointsToo) {
  auto random = seeded_random(413);
  for (const PointMotion motion : {PointMotion::hold, PointMotion::constant_velocity}) {
    std::vector<PointEstimate> all;
    all.reserve(25);
    for (int i = 0; i < 25; ++i) all.push_back({stamp_at(i * 0.04), 0.02 * normal<3>(random), {}});
    PointTrackerConfig config;
    config.motion = motion;
    PointTracker sorted(config), shuffled(config);
    for (const auto& estimate : all) sorted.update(estimate, Verdict::visible);
    std::shuffle(all.begin(), all.end(), random);
    for (const auto& estimate : all) shuffled.update(estimate, Verdict::visible);
    for (double t = 0; t < 3; t += 0.017) {
      EXPECT_EQ(sorted.at(stamp_at(t)).position, shuffled.at(stamp_at(t)).position);
      EXPECT_EQ(sorted.at(stamp_at(t)).covariance, shuffled.at(stamp_at(t)).covariance);
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

TEST(Memory, OfAFewEstimatesForgetsTheOldest) {
  PoseTrackerConfig config;
  config.max_estimates = 3;
  PoseTracker few(config);
  PoseTracker all;
  for (int i = 0; i < 50; ++i) {
    if (i == 48) continue;
    few.update(at_x(0.01 * i, 0.001 * i), Verdict::visible);
    all.update(at_x(0.01 * i, 0.001 * i), Verdict::visible);
  }
  EXPECT_EQ(few.update(at_x(0.48, 0.048), Verdict::visible), Outcome::accepted);
  EXPECT_EQ(all.update(at_x(0.48, 0.048), Verdict::visible), Outcome::accepted);
  expect_same(few.at(stamp_at(0.6)), all.at(stamp_at(0.6)));
  PoseEstimate older = at_x(0.47, 0.047);
  ++older.stamp;
  EXPECT_EQ(few.update(older, Verdict::visible), Outcome::refused_late);
  EXPECT_EQ(all.update(older, Verdict::visible), Outcome::accepted);
  EXPECT_EQ(few.at(stamp_at(0.46)).source, Source::lost);
}

TEST(Clock, JumpBackNeedsAReset) {
  PoseTracker tracker;
  tracker.update(at_x(100, 0), Verdict::visible);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(tracker.update(at_x(0.1 * i, 0), Verdict::visible), Outcome::refused_late);
  }
  EXPECT_EQ(tracker.at(stamp_at(1)).source, Source::lost);
  tracker.reset();
  EXPECT_EQ(tracker.update(at_x(1, 0), Verdict::visible), Outcome::accepted);
  EXPECT_EQ(tracker.at(stamp_at(1)).source, Source::measured);
}

TEST(Clock, AllStampsAreAllowed) {
  PoseTracker tracker;
  constexpr auto least = std::numeric_limits<std::int64_t>::min();
  constexpr auto greatest = std::numeric_limits<std::int64_t>::max();
  PoseEstimate estimate;
  for (const std::int64_t stamp : {least, std::int64_t{0}, greatest}) {
    estimate.stamp = stamp;
    EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
    EXPECT_TRUE(tracker.at(greatest).covariance.allFinite());
  }
  estimate.stamp = least;
  EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::refused_late);
  EXPECT_EQ(tracker.at(least).source, Source::lost);
}

TEST(Memory, NothingIsAllocatedAfterTheFirstSeconds) {
  auto random = seeded_random(414);
  std::uniform_real_distribution<double> uniform(0, 1);
  PoseTracker tracker;
  PointTracker point;
  const auto feed = [&](double from, double to) {
    for (double t = from; t < to; t += 0.02) {
      const double late = t - 0.9 * uniform(random) * uniform(random);
      tracker.update(at_x(late, uniform(random) < 0.1 ? 3.0 : 0.001), Verdict::visible);
      point.update({stamp_at(late), {0, 0, 1}, {}}, Verdict::visible);
      (void)tracker.at(stamp_at(t));
      (void)point.at(stamp_at(t));
    }
  };
  feed(0, 10);
  const std::size_t before = allocations();
  feed(10, 30);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace penumbra::test
