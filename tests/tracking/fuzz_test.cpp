// SPDX-License-Identifier: Apache-2.0
// Whatever comes in whatever order: results stay finite and honest.
#include "../support/algebra.hpp"
#include "tracks.hpp"

namespace penumbra::test {
namespace {

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
