// SPDX-License-Identifier: Apache-2.0
// Covariances are true: over many samples of the model, squared errors in units of the covariance
// follow chi^2 (Bar-Shalom, Li, Kirubarajan 2001, section 5.4: NEES of states, NIS of estimates).
#include "../support/algebra.hpp"
#include "tracks.hpp"

namespace penumbra::test {
namespace {

constexpr int frames = 40;
constexpr double frame = 0.05;
constexpr double deviations = 4.5;  // 1 of 150,000 sound filters would fail by chance

/// Sums of chi^2 of n degrees have mean n and variance 2 n.
struct ChiSquare {
  double sum = 0;
  int degrees = 0;

  void add(double squared, int n) {
    sum += squared;
    degrees += n;
  }
  /// How many standard deviations the sum is off.
  [[nodiscard]] double off() const { return (sum - degrees) / std::sqrt(2.0 * degrees); }
};

struct Statistics {
  ChiSquare state;      // at the last estimate
  ChiSquare predicted;  // half a second after it
  ChiSquare estimates;  // each before it was taken; independent of each other
  int outside_gate = 0, taken = 0;
};

void follow(PoseTrackerConfig config, std::mt19937_64& random, Statistics& statistics) {
  const double gate = config.gate;
  config.gate = 1e6;
  RandomMotion target(config, random);
  PoseTracker tracker(config);
  const Matrix6d noise =
      sigmas(config.position_sigma, config.orientation_sigma).cwiseAbs2().asDiagonal();
  for (int i = 0; i < frames; ++i) {
    const auto estimate = target.estimate(i * frame);
    if (i > 0) {
      const auto expected = tracker.at(estimate.stamp);
      const Vector6d innovation = difference(estimate.pose, expected.pose);
      const double nis = squared_sigmas(innovation, expected.covariance + noise);
      statistics.estimates.add(nis, 6);
      statistics.outside_gate += nis > gate ? 1 : 0;
      ++statistics.taken;
    }
    ASSERT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
    if (i + 1 < frames) target.advance(frame);
  }
  const auto now = tracker.at(stamp_at((frames - 1) * frame));
  statistics.state.add(squared_sigmas(difference(target.pose(), now.pose), now.covariance), 6);
  target.advance(0.5);
  const auto later = tracker.at(stamp_at((frames - 1) * frame + 0.5));
  statistics.predicted.add(squared_sigmas(difference(target.pose(), later.pose), later.covariance),
                           6);
}

class Consistency : public testing::TestWithParam<PoseTrackerConfig> {};

TEST_P(Consistency, ErrorsFollowChiSquare) {
  auto random = seeded_random(441);
  Statistics statistics;
  for (int run = 0; run < samples(200); ++run) follow(GetParam(), random, statistics);
  EXPECT_LT(std::abs(statistics.state.off()), deviations);
  EXPECT_LT(std::abs(statistics.predicted.off()), deviations);
  EXPECT_LT(std::abs(statistics.estimates.off()), deviations);
  // The gate is the 99 % quantile: binomial.
  const double expected = 0.01 * statistics.taken;
  EXPECT_NEAR(statistics.outside_gate, expected, deviations * std::sqrt(0.99 * expected));
}

INSTANTIATE_TEST_SUITE_P(Motions, Consistency, testing::ValuesIn(all_motions()));

TEST(PointConsistency, ErrorsFollowChiSquare) {
  auto random = seeded_random(442);
  const PointTrackerConfig config{.motion = PointMotion::constant_velocity, .gate = 1e6};
  PoseTrackerConfig twin;  // moves as the point does
  twin.motion = Motion::constant_velocity;
  twin.acceleration = config.acceleration;
  twin.speed_sigma = config.speed_sigma;
  twin.position_sigma = config.sigma;
  ChiSquare state, estimates;
  for (int run = 0; run < samples(200); ++run) {
    RandomMotion target(twin, random);
    PointTracker tracker(config);
    for (int i = 0; i < frames; ++i) {
      const auto seen = target.estimate(i * frame);
      const auto expected = tracker.at(seen.stamp);
      if (i > 0) {
        const Vector3d innovation = seen.pose.translation() - expected.position;
        const Matrix3d total =
            expected.covariance + config.sigma * config.sigma * Matrix3d::Identity();
        estimates.add(squared_sigmas(innovation, total), 3);
      }
      tracker.update({seen.stamp, seen.pose.translation()}, Verdict::visible);
      if (i + 1 < frames) target.advance(frame);
    }
    const auto now = tracker.at(stamp_at((frames - 1) * frame));
    const Vector3d error = target.pose().translation() - now.position;
    state.add(squared_sigmas(error, now.covariance), 3);
  }
  EXPECT_LT(std::abs(state.off()), deviations);
  EXPECT_LT(std::abs(estimates.off()), deviations);
}

// A held point's model: after its last estimate it goes away at a constant velocity of held_speed
// per axis.
TEST(PointConsistency, HeldPointsSigmaIsThatOfASteadyHand) {
  auto random = seeded_random(443);
  const PointTrackerConfig config;
  ChiSquare errors;
  for (int run = 0; run < samples(2000); ++run) {
    PointTracker tracker(config);
    const Vector3d start = normal<3>(random), velocity = 0.5 * normal<3>(random);
    tracker.update({stamp_at(0), start + config.sigma * normal<3>(random)}, Verdict::visible);
    const double hidden = 0.02 + 0.001 * run;
    const auto held = tracker.at(stamp_at(hidden));
    const Vector3d error = start + hidden * velocity - held.position;
    errors.add(squared_sigmas(error, held.covariance), 3);
  }
  EXPECT_LT(std::abs(errors.off()), deviations);
}

}  // namespace
}  // namespace penumbra::test
