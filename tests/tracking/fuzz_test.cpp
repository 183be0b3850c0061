// SPDX-License-Identifier: Apache-2.0
// Whatever comes in whatever order: results stay finite and honest.
#include "../support/algebra.hpp"
#include "tracks.hpp"

#include <Eigen/Eigenvalues>

namespace penumbra::test {
namespace {

class Chance {
 public:
  explicit Chance(std::mt19937_64& random) : random_(random) {}

  [[nodiscard]] bool one_of(int n) { return below(n) == 0; }
  [[nodiscard]] int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  [[nodiscard]] double uniform(double low, double high) {
    return test::uniform(random_, low, high);
  }
  [[nodiscard]] double any_number() {
    const double odd[] = {0, 1e300, -1e300, 1e-300, inf, -1e9, 1e155, nan};
    return odd[below(8)];
  }
  [[nodiscard]] std::int64_t stamp(double now) {
    if (one_of(100)) return std::numeric_limits<std::int64_t>::min() + below(5);
    if (one_of(20)) return stamp_at(std::round(now * 10) / 10);  // duplicates
    return stamp_at(now - (one_of(3) ? uniform(0, 2) : 0.0));
  }
  [[nodiscard]] Verdict verdict() { return one_of(2) ? Verdict::visible : Verdict(below(5)); }
  std::mt19937_64& random() { return random_; }

 private:
  std::mt19937_64& random_;
};

PoseEstimate any_estimate(Chance& chance, double now) {
  PoseEstimate estimate{chance.stamp(now), random_pose(chance.random())};
  if (!chance.one_of(4)) estimate.pose.translation() *= 0.01;
  if (!chance.one_of(4)) estimate.pose.linear() = turn({0, 0, 0.01});
  if (chance.one_of(10)) estimate.pose.translation()[chance.below(3)] = chance.any_number();
  if (chance.one_of(10)) estimate.pose.linear()(chance.below(3), 1) = chance.any_number();
  if (chance.one_of(5)) {
    Matrix6d factor;
    for (int i = 0; i < 6; ++i) factor.col(i) = normal<6>(chance.random());
    const double scale = std::pow(10, chance.uniform(-9, 6));
    estimate.covariance = scale * scale * factor * factor.transpose();
    if (chance.one_of(5)) (*estimate.covariance)(chance.below(6), 2) = chance.any_number();
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
  Chance chance(random);
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
      now += chance.one_of(50) ? chance.uniform(0, 1e4) : chance.uniform(0, 0.1);
      const Verdict verdict = chance.verdict();
      const auto outcome = tracker.update(any_estimate(chance, now), verdict);
      accepted += outcome == Outcome::accepted ? 1 : 0;
      if (outcome == Outcome::accepted || outcome == Outcome::refused_gate) {
        EXPECT_LE(verdict, config.worst);
      }
      const double asked = now + chance.uniform(-2, 5);
      expect_honest(tracker.at(stamp_at(asked)), config.timeout);
      if (chance.one_of(200)) tracker.reset();
      if (HasFailure()) return;
    }
    EXPECT_EQ(tracker.at(stamp_at(now + config.timeout + 0.1)).source, Source::lost);
  }
  EXPECT_GT(accepted, samples(20) * 40);  // it was no walk past the filter
}

INSTANTIATE_TEST_SUITE_P(Motions, PoseFuzz, testing::ValuesIn(all_motions()));

}  // namespace
}  // namespace penumbra::test
