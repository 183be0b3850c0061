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

// Whatever comes in whatever order: results stay finite and honest.

bool one_of(std::mt19937_64& random, std::size_t n) { return below(random, n) == 0; }

double any_number(std::mt19937_64& random) {
  const double odd[] = {0, 1e300, -1e300, 1e-300, inf, -1e9, 1e155, nan};
  return odd[below(random, 8)];
}

Eigen::Index any_index(std::mt19937_64& random, std::size_t n) {
  return Eigen::Index(below(random, n));
}

std::int64_t any_stamp(std::mt19937_64& random, double now) {
  if (one_of(random, 100)) return std::numeric_limits<std::int64_t>::min() + any_index(random, 5);
  if (one_of(random, 20)) return stamp_at(std::round(now * 10) / 10);  // duplicates
  return stamp_at(now - (one_of(random, 3) ? uniform(random, 0, 2) : 0.0));
}

PoseEstimate any_estimate(std::mt19937_64& random, double now) {
  PoseEstimate estimate{any_stamp(random, now), random_pose(random)};
  if (!one_of(random, 4)) estimate.pose.translation() *= 0.01;
  if (!one_of(random, 4)) estimate.pose.linear() = turn({0, 0, 0.01});
  if (one_of(random, 10)) estimate.pose.translation()[any_index(random, 3)] = any_number(random);
  if (one_of(random, 10)) estimate.pose.linear()(any_index(random, 3), 1) = any_number(random);
  if (one_of(random, 5)) {
    Matrix6d factor;
    for (int i = 0; i < 6; ++i) factor.col(i) = normal<6>(random);
    const double scale = std::pow(10, uniform(random, -9, 6));
    estimate.covariance = scale * scale * factor * factor.transpose();
    if (one_of(random, 5)) (*estimate.covariance)(any_index(random, 6), 2) = any_number(random);
  }
  return estimate;
}

void expect_covariance(const Eigen::MatrixXd& covariance) {
  constexpr double rounding = 1e-9;
  ASSERT_TRUE(covariance.allFinite());
  EXPECT_EQ(covariance, covariance.transpose());
  // Scaled to ones on its diagonal: metres and radians, and axes known very differently.
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  ASSERT_GT(covariance.diagonal().minCoeff(), 0);
  const Eigen::MatrixXd scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  EXPECT_GT(least_eigenvalue(scaled), -rounding);
}

void expect_honest(const TrackedPose& pose, double timeout) {
  EXPECT_GE(pose.age, 0);
  EXPECT_EQ(pose.source == Source::measured, pose.age == 0);
  EXPECT_EQ(pose.source == Source::lost, pose.age > timeout);
  if (std::isinf(pose.age)) return;
  ASSERT_TRUE(pose.pose.matrix().allFinite());
  ASSERT_TRUE(pose.twist.allFinite());
  const Matrix3d r = pose.pose.linear();
  EXPECT_LT((r.transpose() * r - Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(r.determinant(), 0);
  expect_covariance(pose.covariance);
}

class PoseFuzz : public testing::TestWithParam<PoseTrackerConfig> {};

TEST_P(PoseFuzz, StaysFiniteAndHonest) {
  auto random = seeded_random(461);
  int accepted = 0;
  for (int run = 0; run < samples(20); ++run) {
    auto config = GetParam();
    config.worst = Verdict(run % 3);
    config.memory = run % 4 * 0.5;
    if (run % 2 == 0) config.gate = 1e6;  // so that all motions' corrections are met
    config.max_estimates = 2 + 5 * std::size_t(run);
    PoseTracker tracker(config);
    double now = 0;
    for (int i = 0; i < 400; ++i) {
      now += uniform(random, 0, one_of(random, 50) ? 1e4 : 0.1);
      const auto verdict = Verdict(one_of(random, 2) ? 0 : below(random, 5));
      const auto outcome = tracker.update(any_estimate(random, now), verdict);
      accepted += outcome == Outcome::accepted ? 1 : 0;
      if (outcome == Outcome::accepted || outcome == Outcome::refused_gate) {
        EXPECT_LE(verdict, config.worst);
      }
      const double asked = now + uniform(random, -2, 5);
      expect_honest(tracker.at(stamp_at(asked)), config.timeout);
      if (one_of(random, 200)) tracker.reset();
      if (HasFailure()) return;
    }
    EXPECT_EQ(tracker.at(stamp_at(now + config.timeout + 0.1)).source, Source::lost);
  }
  EXPECT_GT(accepted, samples(20) * 40);  // it was no walk past the filter
}

INSTANTIATE_TEST_SUITE_P(Motions, PoseFuzz, testing::ValuesIn(all_motions()));

}  // namespace
}  // namespace penumbra::test
