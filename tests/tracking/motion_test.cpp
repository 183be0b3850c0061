// SPDX-License-Identifier: Apache-2.0
// Motions with a closed form: fed with true poses, a tracker finds their velocity, and carries them
// on where nobody looks.
#include "tracks.hpp"

namespace penumbra::test {
namespace {

constexpr double frame = 1.0 / 30;
constexpr int frames = 60;
constexpr double hidden = 1.0;  // seconds
// What is left of a new track's unknown velocity after 60 frames of noise-free estimates is some
// 1e-5 of it (the filter trusts none of them fully), times a second.
constexpr double converged = 1e-4;

constexpr double stamp_rounding = 1e-9;  // half a nanosecond of some 0.2 m/s, for each of a few

/// The pose after frames seen and seconds hidden.
template <class Motion>
TrackedPose follow(const PoseTrackerConfig& config, const Motion& pose_at) {
  PoseTracker tracker(config);
  for (int i = 0; i < frames; ++i) {
    const PoseEstimate estimate{stamp_at(i * frame), pose_at(i * frame), {}};
    EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
  }
  return tracker.at(stamp_at((frames - 1) * frame + hidden));
}

constexpr double seen_until = (frames - 1) * frame;

TEST(PoseMotion, ConstantTwistIsCarriedOnExactly) {
  auto random = seeded_random(401);
  for (int run = 0; run < 20; ++run) {
    const Twisting truth{random_pose(random), 0.3 * normal<3>(random), 0.5 * normal<3>(random)};
    const auto pose = follow({}, [&](double t) { return truth.at(t); });
    EXPECT_LT(difference(pose.pose, truth.at(seen_until + hidden)).norm(), converged);
    EXPECT_LT((pose.twist.head<3>() - truth.velocity).norm(), converged);
    EXPECT_LT((pose.twist.tail<3>() - truth.turning).norm(), converged);
    EXPECT_EQ(pose.source, Source::predicted);
    EXPECT_NEAR(pose.age, hidden, 1e-9);
  }
}

TEST(PoseMotion, ConveyorKeepsItsDirection) {
  Twisting truth;
  truth.start.linear() = turn({0.1, 0.2, 0.3});
  const Vector3d direction = Vector3d(1, 2, 0).normalized();
  truth.velocity = 0.25 * direction;
  PoseTrackerConfig config{.motion = Motion::along_direction, .direction = 7 * direction};
  const auto estimated = follow(config, [&](double t) { return truth.at(t); });
  EXPECT_LT(difference(estimated.pose, truth.at(seen_until + hidden)).norm(), converged);
  EXPECT_LT(estimated.twist.head<3>().cross(direction).norm(), 1e-12);
  EXPECT_EQ(estimated.source, Source::predicted);
  config.speed = 0.25;
  const auto known = follow(config, [&](double t) { return truth.at(t); });
  EXPECT_LT(difference(known.pose, truth.at(seen_until + hidden)).norm(), stamp_rounding);
  EXPECT_EQ((known.twist.head<3>() - truth.velocity).norm(), 0);
  EXPECT_LT(known.covariance.trace(), estimated.covariance.trace());
}

TEST(PointMotion, HeldPointIsTheLastOneAndItsSigmaGrowsWithTime) {
  PointTracker tracker({.sigma = 0.02, .held_speed = 0.5});
  tracker.update({stamp_at(0), {1, 2, 3}, {}}, Verdict::visible);
  tracker.update({stamp_at(0.1), {1.01, 2, 3}, {}}, Verdict::visible);
  tracker.update({stamp_at(0.2), {9, 9, 9}, {}}, Verdict::hidden);
  const auto point = tracker.at(stamp_at(1.1));
  EXPECT_EQ(point.source, Source::held);
  EXPECT_EQ(point.position, Vector3d(1.01, 2, 3));
  EXPECT_EQ(point.velocity, Vector3d::Zero());
  EXPECT_NEAR(point.covariance(1, 1), 0.02 * 0.02 + 0.25, 1e-9);
  EXPECT_NEAR(point.age, 1.0, 1e-9);
}

// Late and early estimates: what is known depends on which came, not on when.

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
    for (double t = -0.1; t < 6; t += 0.013)
      expect_same(sorted.at(stamp_at(t)), shuffled.at(stamp_at(t)));
  }
}

TEST(Late, WithinTheMemoryIsTakenAndBeyondItNot) {
  PoseTracker tracker;
  tracker.update(seen_at(0, 0), Verdict::visible);
  tracker.update(seen_at(2, 0), Verdict::visible);
  EXPECT_EQ(tracker.update(seen_at(1.0, 0), Verdict::visible), Outcome::accepted);
  PoseEstimate early = seen_at(1.0, 0);
  --early.stamp;
  EXPECT_EQ(tracker.update(early, Verdict::visible), Outcome::refused_late);
  EXPECT_EQ(tracker.update(seen_at(-1, 0), Verdict::visible), Outcome::refused_late);
}

TEST(Late, TheSameStampTwiceIsRefused) {
  PoseTracker tracker;
  for (int i = 0; i < 5; ++i) tracker.update(seen_at(0.1 * i, 0), Verdict::visible);
  const auto before = tracker.at(stamp_at(0.4));
  EXPECT_EQ(tracker.update(seen_at(0.4, 0.001), Verdict::visible), Outcome::refused_invalid);
  EXPECT_EQ(tracker.update(seen_at(0.2, 0.001), Verdict::visible), Outcome::refused_invalid);
  expect_same(tracker.at(stamp_at(0.4)), before);
  EXPECT_EQ(tracker.update(seen_at(0.5, 0.001), Verdict::hidden), Outcome::refused_verdict);
  EXPECT_EQ(tracker.update(seen_at(0.5, 0.001), Verdict::visible), Outcome::accepted);
}

TEST(Memory, ThePastIsAnsweredWithinIt) {
  PoseTracker tracker;
  for (int i = 0; i <= 100; ++i) tracker.update(seen_at(0.1 * i, 0.02 * i), Verdict::visible);
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
