// SPDX-License-Identifier: Apache-2.0
// Which estimates are taken: verdicts, outliers, the return after an occlusion, the time-out.
#include "tracks.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

constexpr double period = 0.1;

PoseEstimate seen_at(double seconds, double x) {
  PoseEstimate estimate;
  estimate.stamp = stamp_at(seconds);
  estimate.pose.translation().x() = x;
  return estimate;
}

/// A tracker of a target at rest, seen in frames 0 to 9.
PoseTracker settled(const PoseTrackerConfig& config = {}) {
  PoseTracker tracker(config);
  for (int i = 0; i < 10; ++i) tracker.update(seen_at(i * period, 0), Verdict::visible);
  return tracker;
}

double x_at(const PoseTracker& tracker, double seconds) {
  return tracker.at(stamp_at(seconds)).pose.translation().x();
}

TEST(Verdicts, WorseOnesAreRefused) {
  const Verdict all[] = {Verdict::visible, Verdict::partial,     Verdict::hidden,
                         Verdict::unknown, Verdict::out_of_view, Verdict::held};
  for (int worst = 0; worst < 3; ++worst) {
    PoseTrackerConfig config;
    config.worst = all[worst];
    for (int verdict = 0; verdict < 6; ++verdict) {
      PoseTracker tracker(config);
      const auto outcome = tracker.update(seen_at(0, 0), all[verdict]);
      const bool taken = verdict <= worst;  // unknown, out_of_view and held never
      EXPECT_EQ(outcome, taken ? Outcome::accepted : Outcome::refused_verdict);
      EXPECT_EQ(tracker.at(stamp_at(0)).source, taken ? Source::measured : Source::lost);
    }
  }
}

PoseEstimate partly_seen(double seconds, double x, double share) {
  PoseEstimate estimate = seen_at(seconds, x);
  estimate.seen = share;
  return estimate;
}

TEST(PartlySeen, CountsLessTheLessWasSeen) {
  double last = 0.02;  // metres to an estimate that is off by 2 cm
  for (const double share : {0.5, 0.8, 0.9, 1.0}) {
    PoseTrackerConfig config;
    config.gate = 1e6;
    auto tracker = settled(config);
    ASSERT_EQ(tracker.update(partly_seen(10 * period, 0.02, share), Verdict::partial),
              Outcome::accepted);
    const double off = 0.02 - x_at(tracker, 10 * period);
    EXPECT_LT(off, last) << share;
    last = off;
  }
  auto whole = settled();
  whole.update(seen_at(10 * period, 0.002), Verdict::visible);
  auto same = settled();
  same.update(partly_seen(10 * period, 0.002, 1.0), Verdict::partial);
  EXPECT_EQ(x_at(whole, 10 * period), x_at(same, 10 * period));
}

TEST(PartlySeen, IsRefusedHiddenOrBelowTheLeastShareOrByWorst) {
  auto tracker = settled();
  EXPECT_EQ(tracker.update(partly_seen(10 * period, 0, 0.9), Verdict::hidden),
            Outcome::refused_verdict);
  for (const double share : {0.0, 0.3})
    EXPECT_EQ(tracker.update(partly_seen(10 * period, 0, share), Verdict::partial),
              Outcome::refused_verdict);
  PoseTrackerConfig strict;
  strict.worst = Verdict::visible;
  auto strict_tracker = settled(strict);
  EXPECT_EQ(strict_tracker.update(partly_seen(10 * period, 0, 0.9), Verdict::partial),
            Outcome::refused_verdict);
  for (const double share : {-0.1, 1.1, std::nan("")})
    EXPECT_EQ(tracker.update(partly_seen(10 * period, 0, share), Verdict::partial),
              Outcome::refused_invalid);
}

TEST(Sources, FollowVerdictsFrameByFrame) {
  auto tracker = settled();
  EXPECT_EQ(tracker.at(stamp_at(9 * period)).source, Source::measured);
  double sigma = 0;
  for (int i = 10; i < 30; ++i) {
    tracker.update(seen_at(i * period, 0.3), Verdict::hidden);
    const auto pose = tracker.at(stamp_at(i * period));
    EXPECT_EQ(pose.source, Source::predicted);
    EXPECT_NEAR(pose.age, (i - 9) * period, 1e-9);
    EXPECT_GT(pose.covariance.trace(), sigma);  // what is not seen is less and less certain
    sigma = pose.covariance.trace();
  }
  EXPECT_EQ(tracker.update(seen_at(3.0, 0.01), Verdict::visible), Outcome::accepted);
  const auto back = tracker.at(stamp_at(3.0));
  EXPECT_EQ(back.source, Source::measured);
  EXPECT_EQ(back.age, 0);
  EXPECT_LT(back.covariance.trace(), sigma);
  EXPECT_EQ(tracker.at(stamp_at(3.0) + 1).source, Source::predicted);
}

TEST(Sources, LostAfterTheTimeOutAndNotBefore) {
  const auto tracker = settled();
  EXPECT_EQ(tracker.at(stamp_at(0.9 + 3.0)).source, Source::predicted);
  EXPECT_EQ(tracker.at(stamp_at(0.9 + 3.0) + 1000).source, Source::lost);
  EXPECT_NEAR(tracker.at(stamp_at(0.9 + 10)).age, 10, 1e-9);
}

TEST(Sources, NothingIsKnownBeforeTheFirst) {
  const PoseTracker empty;
  const auto nothing = empty.at(stamp_at(0));
  EXPECT_EQ(nothing.source, Source::lost);
  EXPECT_TRUE(std::isinf(nothing.age));
  EXPECT_TRUE(std::isinf(nothing.covariance(0, 0)));
  const auto tracker = settled();
  EXPECT_EQ(tracker.at(stamp_at(0) - 1).source, Source::lost);
  EXPECT_EQ(tracker.at(stamp_at(0)).source, Source::measured);
}

TEST(Gate, OneOutlierChangesNothing) {
  auto tracker = settled();
  const auto with = settled();
  EXPECT_EQ(tracker.update(seen_at(1.0, 0.5), Verdict::visible), Outcome::refused_gate);
  EXPECT_EQ(tracker.at(stamp_at(1.0)).source, Source::predicted);
  EXPECT_NEAR(tracker.at(stamp_at(1.0)).age, period, 1e-9);
  EXPECT_EQ(x_at(tracker, 1.0), x_at(with, 1.0));
  EXPECT_EQ(tracker.update(seen_at(1.1, 0), Verdict::visible), Outcome::accepted);
}

TEST(Gate, ConsistentOutliersMakeANewTrack) {
  auto tracker = settled();
  const double speed = 0.2;  // it is also moving
  for (int i = 10; i < 14; ++i) {
    EXPECT_EQ(tracker.update(seen_at(i * period, 1 + speed * i * period), Verdict::visible),
              Outcome::refused_gate);
    EXPECT_NEAR(x_at(tracker, i * period), 0, 1e-3);
  }
  EXPECT_EQ(tracker.update(seen_at(1.4, 1 + speed * 1.4), Verdict::visible), Outcome::accepted);
  const auto jumped = tracker.at(stamp_at(1.4));
  EXPECT_EQ(jumped.source, Source::measured);
  EXPECT_NEAR(jumped.pose.translation().x(), 1 + speed * 1.4, 2e-3);
  EXPECT_NEAR(jumped.twist[0], speed, 0.05);  // learnt while it was an outlier
}

// A prediction that went astray: the gate has grown with what is not known, so that the target is
// found again at once, while what cannot be is still refused.
TEST(Return, GateGrowsWithTheOcclusion) {
  PoseTrackerConfig config;
  config.acceleration = 0.1;
  constexpr double off = 0.15;
  for (const double hidden : {0.2, 2.0}) {
    auto tracker = settled(config);
    const double back = 0.9 + hidden;
    EXPECT_EQ(tracker.update(seen_at(back, 3), Verdict::visible), Outcome::refused_gate);
    EXPECT_EQ(tracker.update(seen_at(back + 0.01, off), Verdict::visible),
              hidden < 1 ? Outcome::refused_gate : Outcome::accepted);
    if (hidden > 1) {
      EXPECT_NEAR(x_at(tracker, back + 0.01), off, 0.01);
    }
  }
}

TEST(Return, WhatWasLostBeginsAnew) {
  auto tracker = settled();
  for (int i = 10; i < 20; ++i)
    tracker.update(seen_at(i * period, 0.02 * (i - 9)), Verdict::visible);
  EXPECT_GT(tracker.at(stamp_at(2)).twist[0], 0.1);
  EXPECT_EQ(tracker.update(seen_at(30, 2.5), Verdict::visible), Outcome::accepted);
  const auto anew = tracker.at(stamp_at(30));
  EXPECT_EQ(anew.source, Source::measured);
  EXPECT_EQ(anew.pose.translation().x(), 2.5);
  EXPECT_EQ(anew.twist.norm(), 0);
  EXPECT_NEAR(anew.covariance(0, 0), 25e-6, 1e-12);
}

}  // namespace
}  // namespace penumbra::test
