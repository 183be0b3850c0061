// SPDX-License-Identifier: Apache-2.0
// The parts of the filter against their definitions: Jacobians by differences, noise by the matrix
// exponential.
#include "../support/algebra.hpp"
#include "../support/random.hpp"
#include "smoother.hpp"
#include "tracks.hpp"

#include <gtest/gtest.h>

#include <penumbra/tracking/gaussian-inl.hpp>
#include <penumbra/tracking/pose_filter-inl.hpp>
#include <penumbra/tracking/rotation_vector-inl.hpp>

namespace penumbra::test {
namespace {

using detail::PoseFilter;

// Angles on both sides of where series take over, and beyond a turn.
const double angles[] = {0, 1e-9, 1e-4, 0.05, 0.0999, 0.1001, 0.5, 3.0, 3.2, 9.0};

TEST(RotationVector, ExponentialAndLogarithm) {
  auto random = seeded_random(431);
  for (const double angle : angles) {
    const Eigen::Vector3d v = angle * normal<3>(random).normalized();
    EXPECT_LT((detail::rotation_of(v).toRotationMatrix() - turn(v)).norm(), 1e-14);
    if (angle < 3.1) {
      EXPECT_LT((detail::vector_of(detail::rotation_of(v)) - v).norm(), 1e-13);
    }
  }
}

TEST(RotationVector, LeftJacobianIsTheDerivative) {
  constexpr double step = 1e-6;
  constexpr double tolerance = 1e-8;  // step^2 and rounding / step, times the angle
  auto random = seeded_random(432);
  for (const double angle : angles) {
    const Eigen::Vector3d v = angle * normal<3>(random).normalized();
    Eigen::Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(i);
      numeric.col(i) = turn_vector(turn(v + d) * turn(v - d).transpose()) / (2 * step);
    }
    EXPECT_LT((detail::left_jacobian(v) - numeric).norm(), tolerance) << angle;
  }
}

TEST(AngularNoise, IsTheIntegral) {
  constexpr double tolerance = 1e-11;
  auto random = seeded_random(433);
  MotionModel model;
  model.density.tail<3>().setOnes();
  for (const double seconds : {0.01, 0.3, 2.0}) {
    for (const double angle : angles) {
      const Eigen::Vector3d w = angle / seconds * normal<3>(random).normalized();
      const Matrix12d expected = model.noise(w, seconds);
      const auto noise = detail::angular_noise(w, seconds);
      EXPECT_LT((noise.angle - expected.block<3, 3>(3, 3)).norm(), tolerance * seconds) << angle;
      EXPECT_LT((noise.mixed - expected.block<3, 3>(3, 9)).norm(), tolerance * seconds) << angle;
    }
  }
}

PoseFilter::State random_state(const PoseFilter& filter, std::mt19937_64& random) {
  PoseFilter::Measurement m;
  m.covariance = sigmas(0.01, 0.05).cwiseAbs2().asDiagonal();
  auto state = filter.begin(m);
  state.position = normal<3>(random);
  state.orientation = Eigen::Quaterniond(turn(normal<3>(random)));
  state.twist = normal<6>(random);
  return state;
}

Node node_of(const PoseFilter::State& state) {
  return {pose_of(state.position, state.orientation.toRotationMatrix()), state.twist};
}

/// The derivative of the motion without noise, by differences.
Matrix12d transition(const Node& node, double seconds) {
  constexpr double step = 1e-6;
  Matrix12d result;
  for (int i = 0; i < 12; ++i) {
    const Vector12d d = step * Vector12d::Unit(i);
    const auto at = [&](double sign) {
      const Node near{moved(node.pose, sign * d.head<6>()), node.twist + sign * d.tail<6>()};
      return MotionModel::carried_on(near, seconds);
    };
    result.col(i) << difference(at(1).pose, at(-1).pose) / (2 * step),
        (at(1).twist - at(-1).twist) / (2 * step);
  }
  return result;
}

TEST(Prediction, CovarianceIsThatOfTheModel) {
  constexpr double tolerance = 1e-8;  // of differences
  auto random = seeded_random(434);
  const PoseTrackerConfig config;
  const PoseFilter filter(config);
  MotionModel model;
  model.density.segment<3>(6).setConstant(config.acceleration * config.acceleration);
  model.density.tail<3>().setConstant(config.angular_acceleration * config.angular_acceleration);
  for (const double seconds : {1e-3, 0.1, 2.0}) {
    const auto state = random_state(filter, random);
    const Matrix12d f = transition(node_of(state), seconds);
    const Matrix12d expected =
        f * state.covariance * f.transpose() + model.noise(state.twist.tail<3>(), seconds);
    const auto later = filter.predicted(state, seconds);
    EXPECT_LT((later.covariance - expected).norm(), tolerance * expected.norm());
    const auto off =
        difference(node_of(later).pose, MotionModel::carried_on(node_of(state), seconds).pose);
    EXPECT_LT(off.norm(), 1e-13);
  }
}

TEST(Prediction, TwoStepsAreOne) {
  constexpr double tolerance = 1e-12;
  auto random = seeded_random(435);
  const PoseFilter filter{PoseTrackerConfig{}};
  const auto state = random_state(filter, random);
  const auto once = filter.predicted(state, 1.5);
  auto parts = filter.predicted(state, 0.2);
  parts = filter.predicted(parts, 1.2);
  parts = filter.predicted(parts, 0.1);
  EXPECT_LT((once.covariance - parts.covariance).norm(), tolerance * once.covariance.norm());
  EXPECT_LT((once.position - parts.position).norm(), tolerance);
  EXPECT_LT(once.orientation.angularDistance(parts.orientation), 1e-7);  // arccos near 1
}

TEST(Correction, IsTheInformationFormsOne) {
  constexpr double tolerance = 1e-9;
  auto random = seeded_random(436);
  const PoseFilter filter{PoseTrackerConfig{}};
  auto state = filter.predicted(random_state(filter, random), 0.3);
  Matrix12d covariance = state.covariance;
  Matrix6d noise = Matrix6d::Identity();
  noise(0, 4) = noise(4, 0) = 0.5;
  noise *= 1e-4;
  const Vector6d residual = 0.01 * normal<6>(random);
  const Vector12d change = detail::kalman_correction<12, 6>(covariance, noise, residual);
  Eigen::MatrixXd information = inverse(state.covariance);
  information.topLeftCorner<6, 6>() += inverse(noise);
  const Matrix12d expected = inverse(information);
  EXPECT_LT((covariance - expected).norm(), tolerance * expected.norm());
  const Vector12d step = expected.leftCols<6>() * (inverse(noise) * residual);
  EXPECT_LT((change - step).norm(), tolerance);
}

TEST(SquaredDistance, IsInfiniteWhereItIsNone) {
  const Eigen::Matrix3d none = -Eigen::Matrix3d::Identity();
  EXPECT_TRUE(std::isinf(detail::squared_distance<3>(none, Eigen::Vector3d::Zero())));
  const Eigen::Matrix3d four = 4 * Eigen::Matrix3d::Identity();
  EXPECT_DOUBLE_EQ(detail::squared_distance<3>(four, {2, 0, 4}), 5);
}

}  // namespace
}  // namespace penumbra::test
