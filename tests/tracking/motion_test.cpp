// SPDX-License-Identifier: Apache-2.0
// Motions with a closed form: fed with true poses, a tracker finds their velocity, and carries them
// on where nobody looks.
#include "../support/random.hpp"
#include "tracks.hpp"

#include <gtest/gtest.h>

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
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, 0).normalized();
  truth.velocity = 0.25 * direction;
  PoseTrackerConfig config;
  config.motion = Motion::along_direction;
  config.direction = 7 * direction;
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

TEST(PoseMotion, ConveyorOfKnownSpeedIsRightFromOneEstimate) {
  PoseTrackerConfig config;
  config.motion = Motion::along_direction;
  config.direction = {0, -1, 0};
  config.speed = -0.4;  // against it
  PoseTracker tracker(config);
  tracker.update({stamp_at(0), Eigen::Isometry3d::Identity(), {}}, Verdict::visible);
  EXPECT_LT((tracker.at(stamp_at(2)).pose.translation() - Eigen::Vector3d(0, 0.8, 0)).norm(),
            1e-12);
}

// On a circle of radius r at angular speed w the acceleration is w^2 r: a prediction of T seconds
// that went on straight is off by r |e^(iwT) - 1 - iwT|, to which comes the lag of the velocity.
TEST(PoseMotion, CircleIsLeftOnItsTangent) {
  constexpr double radius = 0.3, speed = 0.8;
  const auto circle = [](double t) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << radius * std::cos(speed * t), radius * std::sin(speed * t), 0.5;
    pose.linear() = turn({0, 0, speed * t});
    return pose;
  };
  const auto pose = follow({}, circle);
  const double angle = speed * hidden;
  const double tangent = radius * std::hypot(std::cos(angle) - 1, std::sin(angle) - angle);
  const double off = (pose.pose.translation() - circle(seen_until + hidden).translation()).norm();
  constexpr double lag = 0.35;  // of the tangent's error, as the filter averages over 0.2 s
  EXPECT_NEAR(off, tangent, lag * tangent);
  const Eigen::Matrix3d turned = circle(seen_until + hidden).linear();
  EXPECT_LT(turn_vector(pose.pose.linear() * turned.transpose()).norm(), converged);
}

TEST(PointMotion, HeldPointIsTheLastOneAndItsSigmaGrowsWithTime) {
  PointTrackerConfig config;
  config.sigma = 0.02;
  config.held_speed = 0.5;
  PointTracker tracker(config);
  tracker.update({stamp_at(0), {1, 2, 3}, {}}, Verdict::visible);
  tracker.update({stamp_at(0.1), {1.01, 2, 3}, {}}, Verdict::visible);
  tracker.update({stamp_at(0.2), {9, 9, 9}, {}}, Verdict::hidden);
  const auto point = tracker.at(stamp_at(1.1));
  EXPECT_EQ(point.source, Source::held);
  EXPECT_EQ(point.position, Eigen::Vector3d(1.01, 2, 3));
  EXPECT_EQ(point.velocity, Eigen::Vector3d::Zero());
  EXPECT_NEAR(point.covariance(1, 1), 0.02 * 0.02 + 0.25, 1e-9);
  EXPECT_NEAR(point.age, 1.0, 1e-9);
}

}  // namespace
}  // namespace penumbra::test
