// SPDX-License-Identifier: Apache-2.0
// Which estimates are taken: verdicts, outliers, the return after an occlusion, the time-out; and
// what cannot be right.
#include "tracks.hpp"

namespace penumbra::test {
namespace {

constexpr double period = 0.1;

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
    for (int verdict = 0; verdict < 6; ++verdict) {
      PoseTracker tracker({.worst = all[worst]});
      const auto outcome = tracker.update(seen_at(0, 0), all[verdict]);
      const bool taken = verdict <= worst;  // unknown, out_of_view and held never
      EXPECT_EQ(outcome, taken ? Outcome::accepted : Outcome::refused_verdict);
      EXPECT_EQ(tracker.at(stamp_at(0)).source, taken ? Source::measured : Source::lost);
    }
  }
}

PoseEstimate partly_seen(double seconds, double x, double share) {
  return {.stamp = stamp_at(seconds), .pose = at(x, 0, 0), .seen = share};
}

TEST(PartlySeen, CountsLessTheLessWasSeen) {
  double last = 0.02;  // metres to an estimate that is off by 2 cm
  for (const double share : {0.5, 0.8, 0.9, 1.0}) {
    auto tracker = settled({.gate = 1e6});
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
  auto strict = settled({.worst = Verdict::visible});
  EXPECT_EQ(strict.update(partly_seen(10 * period, 0, 0.9), Verdict::partial),
            Outcome::refused_verdict);
  for (const double share : {-0.1, 1.1, nan})
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
  constexpr double off = 0.15;
  for (const double hidden : {0.2, 2.0}) {
    auto tracker = settled({.acceleration = 0.1});
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

TEST(TrackerConfig, SaysWhichFieldIsWrong) {
  using Config = PoseTrackerConfig;
  const std::vector<std::pair<std::string, Config>> faults{
      {"position_sigma 0", {.position_sigma = 0}},
      {"orientation_sigma nan", {.orientation_sigma = nan}},
      {"acceleration -1", {.acceleration = -1}},
      {"angular_drift -1", {.angular_drift = -1}},
      {"timeout 0", {.timeout = 0}},
      {"gate_patience 0", {.gate_patience = 0}},
      {"max_estimates 1", {.max_estimates = 1}},
      {"worst unknown", {.worst = Verdict::unknown}},
      {"direction is (0, 0, 0)", {.motion = Motion::along_direction}},
      {"speed is given", {.speed = 1}}};
  for (const auto& [part, config] : faults) expect_refused([&c = config] { c.check(); }, {part});
}

/// What becomes of an estimate that was right before `spoil`.
Outcome outcome_of(const std::function<void(PoseEstimate&)>& spoil) {
  PoseTracker tracker;
  PoseEstimate estimate;
  estimate.covariance = Matrix6d::Identity();
  spoil(estimate);
  const Outcome outcome = tracker.update(estimate, Verdict::visible);
  EXPECT_EQ(tracker.at(0).source, outcome == Outcome::accepted ? Source::measured : Source::lost);
  return outcome;
}

TEST(BadEstimates, AreRefusedAsInvalid) {
  using Estimate = PoseEstimate;
  EXPECT_EQ(outcome_of([](Estimate&) {}), Outcome::accepted);
  const std::vector<std::function<void(Estimate&)>> faults{
      [](Estimate& e) { e.pose.translation().y() = nan; },
      [](Estimate& e) { e.pose.translation().x() = inf; },
      [](Estimate& e) { e.pose.linear()(0, 1) = nan; },
      [](Estimate& e) { e.pose.linear().setZero(); },
      [](Estimate& e) { e.pose.linear() *= 1.001; },
      [](Estimate& e) { e.pose.linear()(2, 2) = -1; },
      [](Estimate& e) { e.pose.linear()(0, 1) = 1e-3; },
      [](Estimate& e) { (*e.covariance)(0, 0) = nan; },
      [](Estimate& e) { (*e.covariance)(3, 3) = -1; },
      [](Estimate& e) { (*e.covariance)(4, 4) = 0; },
      [](Estimate& e) { (*e.covariance)(0, 1) = 0.5; },
      [](Estimate& e) { (*e.covariance)(0, 1) = (*e.covariance)(1, 0) = 1.5; },
      [](Estimate& e) { e.covariance->setZero(); },
      [](Estimate& e) { *e.covariance *= 1e30; }};
  for (std::size_t i = 0; i < faults.size(); ++i)
    EXPECT_EQ(outcome_of(faults[i]), Outcome::refused_invalid) << "fault " << i;
}

TEST(BadEstimates, RotationsOfTextFilesAreTaken) {
  Matrix3d rounded = turn({0.3, -1.2, 0.8});
  rounded = (rounded * 1e5).array().round() / 1e5;
  PoseTracker tracker;
  PoseEstimate estimate;
  estimate.pose.linear() = rounded;
  EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
  const Matrix3d kept = tracker.at(0).pose.linear();
  EXPECT_LT((kept.transpose() * kept - Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((kept - rounded).norm(), 3e-5);  // nine entries, each rounded by half a digit
}

}  // namespace
}  // namespace penumbra::test
