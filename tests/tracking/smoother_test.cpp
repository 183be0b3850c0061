// SPDX-License-Identifier: Apache-2.0
// A filter and a smoother of all estimates at once know the same of the last stamp: exactly where
// the model is linear, and nearly so on SO(3).
#include "smoother.hpp"

#include "../support/algebra.hpp"
#include "../support/random.hpp"
#include "tracks.hpp"

#include <gtest/gtest.h>

namespace penumbra::test {
namespace {

// Both are exact; differences are of rounding (the smoother's derivatives are of differences).
constexpr double linear_tolerance = 1e-8;           // metres
constexpr double linear_variance_tolerance = 1e-6;  // of the variance

MotionModel model_of(const PoseTrackerConfig& config) {
  MotionModel model;
  const auto fill = [](auto&& part, double sigma) { part.setConstant(sigma * sigma); };
  if (config.motion == Motion::constant_twist) {
    fill(model.density.segment<3>(9), config.angular_acceleration);
    fill(model.twist_variance.tail<3>(), config.angular_speed_sigma);
  } else {
    fill(model.density.segment<3>(3), config.angular_drift);
  }
  if (config.motion == Motion::still) {
    fill(model.density.segment<3>(0), config.drift);
  } else if (config.motion == Motion::along_direction) {  // x
    fill(model.density.segment<2>(1), config.drift);
    if (config.speed) {
      fill(model.density.segment<1>(0), config.drift);
      model.twist[0] = *config.speed;
    } else {
      fill(model.density.segment<1>(6), config.acceleration);
      fill(model.twist_variance.segment<1>(0), config.speed_sigma);
    }
  } else {
    fill(model.density.segment<3>(6), config.acceleration);
    fill(model.twist_variance.head<3>(), config.speed_sigma);
  }
  return model;
}

Matrix6d random_covariance(const Vector6d& scale, bool apart, std::mt19937_64& random) {
  Matrix6d factor = Matrix6d::Identity();
  for (int i = 0; i < 6; ++i) factor.col(i) += 0.3 * normal<6>(random);
  if (apart) {
    factor.topRightCorner<3, 3>().setZero();
    factor.bottomLeftCorner<3, 3>().setZero();
  }
  factor = scale.asDiagonal() * factor;
  return factor * factor.transpose();
}

/// Estimates of a moving target, with covariances of their own, at irregular stamps.
std::vector<SeenPose> seen_poses(const Vector6d& scale, bool apart, std::mt19937_64& random) {
  std::uniform_real_distribution<double> gap(0.01, 0.12);
  const Twisting truth{random_pose(random), {0.3, 0.02, -0.01}, 0.4 * normal<3>(random)};
  std::vector<SeenPose> all;
  double t = 0;
  for (int i = 0; i < 25; ++i, t += gap(random)) {
    SeenPose one;
    one.seconds = std::round(t * 1e9) / 1e9;
    one.covariance = random_covariance(scale, apart, random);
    one.pose = moved(truth.at(t), root(one.covariance) * normal<6>(random));
    all.push_back(one);
  }
  return all;
}

TrackedPose filtered(PoseTrackerConfig config, const std::vector<SeenPose>& seen) {
  config.gate = 1e6;  // the smoother has none
  config.memory = 0;
  PoseTracker tracker(config);
  for (const auto& one : seen) {
    const PoseEstimate estimate{stamp_at(one.seconds), one.pose, one.covariance};
    EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
  }
  return tracker.at(stamp_at(seen.back().seconds));
}

class LinearMotion : public testing::TestWithParam<PoseTrackerConfig> {};

TEST_P(LinearMotion, FilterIsTheSmoothersEnd) {
  auto random = seeded_random(421);
  for (int run = 0; run < 3; ++run) {
    const auto seen = seen_poses(sigmas(0.005, 0.03), true, random);
    const auto pose = filtered(GetParam(), seen);
    const auto smoothed = smooth(model_of(GetParam()), seen);
    const Node& last = smoothed.nodes.back();
    EXPECT_LT((pose.pose.translation() - last.pose.translation()).norm(), linear_tolerance);
    EXPECT_LT((pose.twist - last.twist).head<3>().norm(), 10 * linear_tolerance);
    const Eigen::Matrix3d expected = smoothed.last_covariance.topLeftCorner<3, 3>();
    const Eigen::Matrix3d off = pose.covariance.topLeftCorner<3, 3>() - expected;
    EXPECT_LT(off.norm(), linear_variance_tolerance * expected.norm());
  }
}

PoseTrackerConfig with_motion(Motion motion) {
  PoseTrackerConfig config;
  config.motion = motion;
  if (motion == Motion::along_direction) config.direction = {1, 0, 0};
  return config;
}

PoseTrackerConfig known_speed() {
  auto config = with_motion(Motion::along_direction);
  config.speed = 0.3;
  return config;
}

INSTANTIATE_TEST_SUITE_P(Motions, LinearMotion,
                         testing::Values(with_motion(Motion::constant_twist),
                                         with_motion(Motion::constant_velocity),
                                         with_motion(Motion::along_direction), known_speed(),
                                         with_motion(Motion::still)));

TEST(PointSmoother, FilterIsItsEnd) {
  auto random = seeded_random(422);
  PointTrackerConfig config;
  config.motion = PointMotion::constant_velocity;
  config.gate = 1e6;
  PointTracker tracker(config);
  PoseTrackerConfig twin = with_motion(Motion::constant_velocity);
  twin.acceleration = config.acceleration;
  twin.speed_sigma = config.speed_sigma;
  const auto seen = seen_poses(sigmas(0.01, 0.03), true, random);
  for (const auto& one : seen) {
    const Eigen::Matrix3d covariance = one.covariance.topLeftCorner<3, 3>();
    tracker.update({stamp_at(one.seconds), one.pose.translation(), covariance}, Verdict::visible);
  }
  const auto point = tracker.at(stamp_at(seen.back().seconds));
  const auto smoothed = smooth(model_of(twin), seen);
  EXPECT_LT((point.position - smoothed.nodes.back().pose.translation()).norm(), linear_tolerance);
  EXPECT_LT((point.velocity - smoothed.nodes.back().twist.head<3>()).norm(), 10 * linear_tolerance);
  const Eigen::Matrix3d expected = smoothed.last_covariance.topLeftCorner<3, 3>();
  EXPECT_LT((point.covariance - expected).norm(), linear_variance_tolerance * expected.norm());
}

}  // namespace
}  // namespace penumbra::test
