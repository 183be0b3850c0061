// SPDX-License-Identifier: Apache-2.0
// A filter knows of the last stamp what all estimates at once say of it: position and velocity are
// jointly normal with the estimates, and the motion is linear.
#include "../support/algebra.hpp"
#include "tracks.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace penumbra::test {
namespace {

using Matrix = Eigen::MatrixXd;

/// The stochastic model of position and velocity.
struct MotionModel {
  Vector3d velocity = Vector3d::Zero();  ///< of a new track: mean and covariance
  Matrix3d velocity_covariance = Matrix3d::Zero();
  Matrix6d density = Matrix6d::Zero();  ///< of the white noise

  /// The motion without noise.
  [[nodiscard]] static Matrix6d transition(double seconds) {
    Matrix6d motion = Matrix6d::Identity();
    motion.topRightCorner<3, 3>().diagonal().setConstant(seconds);
    return motion;
  }
  /// Covariance that the noise adds over some time, by matrix exponential (Van Loan, "Computing
  /// integrals involving the matrix exponential", 1978).
  [[nodiscard]] Matrix6d noise(double seconds) const {
    const Matrix6d dynamics = transition(1.0) - Matrix6d::Identity();
    Matrix joint = Matrix::Zero(12, 12);
    joint.topLeftCorner<6, 6>() = -dynamics;
    joint.topRightCorner<6, 6>() = density;
    joint.bottomRightCorner<6, 6>() = dynamics.transpose();
    const Matrix exponential = (seconds * joint).exp();
    return exponential.bottomRightCorner<6, 6>().transpose() * exponential.topRightCorner<6, 6>();
  }
};

MotionModel model_of(const PoseTrackerConfig& config) {
  Matrix3d free;
  for (int i = 0; i < 3; ++i) free.col(i) = along(config, Vector3d::Unit(i));
  MotionModel model;
  if (config.speed) model.velocity = *config.speed * config.direction.normalized();
  model.velocity_covariance = config.speed_sigma * config.speed_sigma * free;
  model.density.topLeftCorner<3, 3>() = config.drift * config.drift * (Matrix3d::Identity() - free);
  model.density.bottomRightCorner<3, 3>() = config.acceleration * config.acceleration * free;
  return model;
}

struct Known {
  Vector6d state;  ///< position and velocity
  Matrix6d covariance;
};

/// What all estimates say of the last stamp. Errors are sums of independent ones: of the first
/// state, of the noise before each later stamp, and of each later estimate.
Known known_at_last(const MotionModel& model, const std::vector<PoseEstimate>& seen) {
  const int later = int(seen.size()) - 1;
  const auto time = [&](int i) {
    return 1e-9 * double(seen[std::size_t(i)].stamp - seen[0].stamp);
  };
  const auto motion = [&](int to, int from) {
    return MotionModel::transition(time(to) - time(from));
  };
  Vector6d start;
  start << seen[0].pose.translation(), model.velocity;
  const int sources = 6 * (later + 1), size = sources + 3 * later;
  Matrix errors = Matrix::Zero(size, size);  // their covariance
  Matrix in_seen = Matrix::Zero(3 * later, size), in_last = Matrix::Zero(6, size);
  Eigen::VectorXd off(3 * later);  // of the estimates, from the motion of the first
  errors.topLeftCorner<3, 3>() = seen[0].covariance->topLeftCorner<3, 3>();
  errors.block<3, 3>(3, 3) = model.velocity_covariance;
  for (int i = 0; i <= later; ++i) {
    in_last.middleCols<6>(6 * i) = motion(later, i);
    for (int j = std::max(i, 1); j <= later; ++j)
      in_seen.block<3, 6>(3 * (j - 1), 6 * i) = motion(j, i).topRows<3>();
    if (i == 0) continue;
    const PoseEstimate& estimate = seen[std::size_t(i)];
    const int row = 3 * (i - 1), own = sources + row;
    errors.block<6, 6>(6 * i, 6 * i) = model.noise(time(i) - time(i - 1));
    errors.block<3, 3>(own, own) = estimate.covariance->topLeftCorner<3, 3>();
    in_seen.block<3, 3>(row, own).setIdentity();
    off.segment<3>(row) = estimate.pose.translation() - (motion(i, 0) * start).head<3>();
  }
  const Matrix shared = errors * in_seen.transpose();
  const Matrix gain = in_last * shared * inverse(in_seen * shared);
  const Matrix left = in_last - gain * in_seen;
  return {motion(later, 0) * start + gain * off, left * errors * left.transpose()};
}

// Both are exact; differences are of rounding.
constexpr double linear_tolerance = 1e-8;           // metres
constexpr double linear_variance_tolerance = 1e-6;  // of the variance

void expect_known(const Known& known, const Vector3d& position, const Vector3d& velocity,
                  const Matrix3d& covariance) {
  EXPECT_LT((position - known.state.head<3>()).norm(), linear_tolerance);
  EXPECT_LT((velocity - known.state.tail<3>()).norm(), 10 * linear_tolerance);
  const Matrix3d expected = known.covariance.topLeftCorner<3, 3>();
  EXPECT_LT((covariance - expected).norm(), linear_variance_tolerance * expected.norm());
}

/// Position and orientation are independent.
Matrix6d random_covariance(const Vector6d& scale, std::mt19937_64& random) {
  Matrix6d factor = Matrix6d::Identity();
  for (int i = 0; i < 6; ++i) factor.col(i) += 0.3 * normal<6>(random);
  factor.topRightCorner<3, 3>().setZero();
  factor.bottomLeftCorner<3, 3>().setZero();
  factor = scale.asDiagonal() * factor;
  return factor * factor.transpose();
}

/// Estimates of a moving target, with covariances of their own, at irregular stamps.
std::vector<PoseEstimate> seen_poses(const Vector6d& scale, std::mt19937_64& random) {
  std::uniform_real_distribution<double> gap(0.01, 0.12);
  const Twisting truth{random_pose(random), {0.3, 0.02, -0.01}, 0.4 * normal<3>(random)};
  std::vector<PoseEstimate> all;
  for (double t = 0; all.size() < 25; t += gap(random)) {
    const Matrix6d covariance = random_covariance(scale, random);
    all.push_back(
        {stamp_at(t), moved(truth.at(t), root(covariance) * normal<6>(random)), covariance});
  }
  return all;
}

class LinearMotion : public testing::TestWithParam<PoseTrackerConfig> {};

TEST_P(LinearMotion, FilterIsTheSmoothersEnd) {
  auto random = seeded_random(421);
  PoseTrackerConfig config = GetParam();
  config.gate = 1e6;
  config.memory = 0;
  for (int run = 0; run < 3; ++run) {
    const auto seen = seen_poses(sigmas(0.005, 0.03), random);
    PoseTracker tracker(config);
    for (const PoseEstimate& estimate : seen)
      EXPECT_EQ(tracker.update(estimate, Verdict::visible), Outcome::accepted);
    const TrackedPose pose = tracker.at(seen.back().stamp);
    expect_known(known_at_last(model_of(config), seen), pose.pose.translation(),
                 pose.twist.head<3>(), pose.covariance.topLeftCorner<3, 3>());
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, LinearMotion, testing::ValuesIn(all_motions()));

TEST(PointSmoother, FilterIsItsEnd) {
  auto random = seeded_random(422);
  const PointTrackerConfig config{.motion = PointMotion::constant_velocity, .gate = 1e6};
  PointTracker tracker(config);
  PoseTrackerConfig twin{.motion = Motion::constant_velocity};
  twin.acceleration = config.acceleration;
  twin.speed_sigma = config.speed_sigma;
  const auto seen = seen_poses(sigmas(0.01, 0.03), random);
  for (const PoseEstimate& one : seen) {
    const Matrix3d covariance = one.covariance->topLeftCorner<3, 3>();
    tracker.update({one.stamp, one.pose.translation(), covariance}, Verdict::visible);
  }
  const auto point = tracker.at(seen.back().stamp);
  expect_known(known_at_last(model_of(twin), seen), point.position, point.velocity,
               point.covariance);
}

}  // namespace
}  // namespace penumbra::test
