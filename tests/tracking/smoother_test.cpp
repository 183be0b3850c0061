// SPDX-License-Identifier: Apache-2.0
// A filter and a smoother of all estimates at once know the same of the last stamp: exactly where
// the model is linear, and nearly so on SO(3).
#include "../support/algebra.hpp"
#include "tracks.hpp"

#include <Eigen/Cholesky>
#include <unsupported/Eigen/MatrixFunctions>

namespace penumbra::test {
namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// A target's whole state, components in the order of its errors: position, orientation, linear and
/// angular velocity.
struct Node {
  Isometry3d pose = Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();
};

/// The stochastic model of a motion, by what drives each component.
struct MotionModel {
  Vector12d density = Vector12d::Zero();  ///< white noise into each component, squared
  Vector6d twist = Vector6d::Zero();      ///< of a new track: mean and variances
  Vector6d twist_variance = Vector6d::Zero();

  /// The components that can change: poses and the velocities that have noise or variance.
  [[nodiscard]] std::vector<int> active() const {
    std::vector<int> indices{0, 1, 2, 3, 4, 5};
    for (int i = 0; i < 6; ++i)
      if (twist_variance[i] > 0 || density[6 + i] > 0) indices.push_back(6 + i);
    return indices;
  }
  /// Covariance that the noise adds over some time, by matrix exponential (Van Loan, "Computing
  /// integrals involving the matrix exponential", 1978).
  [[nodiscard]] Matrix12d noise(const Vector3d& turning, double seconds) const {
    Matrix12d dynamics = Matrix12d::Zero();
    dynamics.topRightCorner<6, 6>().setIdentity();
    dynamics.block<3, 3>(3, 3) << 0, -turning.z(), turning.y(), turning.z(), 0, -turning.x(),
        -turning.y(), turning.x(), 0;
    Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(24, 24);
    joint.topLeftCorner<12, 12>() = -dynamics;
    joint.topRightCorner<12, 12>() = density.asDiagonal();
    joint.bottomRightCorner<12, 12>() = dynamics.transpose();
    const Eigen::MatrixXd exponential = (seconds * joint).exp();
    const Matrix12d result =
        exponential.bottomRightCorner<12, 12>().transpose() * exponential.topRightCorner<12, 12>();
    return (result + result.transpose()) / 2;
  }
  /// The motion without noise.
  [[nodiscard]] static Node carried_on(const Node& node, double seconds) {
    const Vector3d turned = seconds * node.twist.tail<3>();
    return {pose_of(node.pose.translation() + seconds * node.twist.head<3>(),
                    turn(turned) * node.pose.linear()),
            node.twist};
  }
};

struct SeenPose {
  double seconds = 0;
  Isometry3d pose = Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Identity();
};

struct Smoothed {
  std::vector<Node> nodes;
  Matrix12d last_covariance = Matrix12d::Zero();
};

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Node changed(const Node& node, const Vector12d& by) {
  return {moved(node.pose, by.head<6>()), node.twist + by.tail<6>()};
}

Vector12d node_difference(const Node& to, const Node& from) {
  Vector12d d;
  d << difference(to.pose, from.pose), to.twist - from.twist;
  return d;
}

Matrix picked(const Matrix& all, const std::vector<int>& indices) { return all(indices, indices); }

/// The normal equations of all residuals, each weighted with its covariance.
class Problem {
 public:
  Problem(std::vector<Node> nodes, std::vector<int> active)
      : nodes_(std::move(nodes)), active_(std::move(active)) {
    const auto size = static_cast<Eigen::Index>(nodes_.size() * active_.size());
    information_ = Matrix::Zero(size, size);
    gradient_ = Vector::Zero(size);
  }

  /// A residual that depends on nodes first..last, and its covariance.
  void add(std::size_t first, std::size_t last, const Matrix& covariance,
           const std::function<Vector(const std::vector<Node>&)>& residual) {
    constexpr double step = 1e-6;
    const auto n = static_cast<Eigen::Index>(active_.size());
    const auto begin = static_cast<Eigen::Index>(first) * n;
    const auto count = static_cast<Eigen::Index>(last - first + 1) * n;
    const Vector e = residual(nodes_);
    Matrix jacobian(e.size(), count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const std::size_t node = first + std::size_t(j / n);
      const Node kept = nodes_[node];
      Vector12d by = Vector12d::Zero();
      by[active_[std::size_t(j % n)]] = step;
      nodes_[node] = changed(kept, by);
      const Vector plus = residual(nodes_);
      nodes_[node] = changed(kept, -by);
      jacobian.col(j) = (plus - residual(nodes_)) / (2 * step);
      nodes_[node] = kept;
    }
    const Matrix weighted = covariance.ldlt().solve(jacobian);
    information_.block(begin, begin, count, count) += jacobian.transpose() * weighted;
    gradient_.segment(begin, count) += weighted.transpose() * e;
  }

  /// Takes one step; returns how long it was.
  double solve() {
    const Vector step = -information_.ldlt().solve(gradient_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Vector12d by = Vector12d::Zero();
      for (std::size_t j = 0; j < active_.size(); ++j)
        by[active_[j]] = step[static_cast<Eigen::Index>(i * active_.size() + j)];
      nodes_[i] = changed(nodes_[i], by);
    }
    return step.norm();
  }

  [[nodiscard]] Matrix12d last_covariance() const {
    const auto n = static_cast<Eigen::Index>(active_.size());
    const Matrix all = inverse(information_);
    Matrix12d covariance = Matrix12d::Zero();
    covariance(active_, active_) = all.bottomRightCorner(n, n);
    return covariance;
  }

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
  std::vector<int> active_;
  Matrix information_;
  Vector gradient_;
};

void add_prior(Problem& problem, const MotionModel& model) {
  std::vector<int> known;
  for (int i = 0; i < 6; ++i)
    if (model.twist_variance[i] > 0) known.push_back(i);
  if (known.empty()) return;
  const Matrix variance = model.twist_variance.asDiagonal();
  problem.add(0, 0, picked(variance, known), [&](const std::vector<Node>& nodes) -> Vector {
    return Vector(nodes[0].twist - model.twist)(known);
  });
}

void add_estimate(Problem& problem, std::size_t i, const SeenPose& seen) {
  problem.add(i, i, seen.covariance, [&](const std::vector<Node>& nodes) -> Vector {
    return difference(nodes[i].pose, seen.pose);
  });
}

void add_motion(Problem& problem, const MotionModel& model, std::size_t i, double seconds) {
  const auto active = model.active();
  const Matrix noise = model.noise(problem.nodes()[i].twist.tail<3>(), seconds);
  problem.add(i, i + 1, picked(noise, active), [&](const std::vector<Node>& nodes) -> Vector {
    const Node carried = MotionModel::carried_on(nodes[i], seconds);
    return Vector(node_difference(nodes[i + 1], carried))(active);
  });
}

std::vector<Node> first_guess(const MotionModel& model, const std::vector<SeenPose>& seen) {
  std::vector<Node> nodes;
  nodes.reserve(seen.size());
  for (const auto& one : seen) nodes.push_back({one.pose, model.twist});
  return nodes;
}

/// The most likely states at all stamps at once: Gauss and Newton's method on a dense matrix, with
/// derivatives by differences.
Smoothed smooth(const MotionModel& model, const std::vector<SeenPose>& seen) {
  constexpr int most_steps = 20;
  constexpr double converged = 1e-11;
  Smoothed result{first_guess(model, seen), {}};
  for (int i = 0; i < most_steps; ++i) {
    Problem problem(result.nodes, model.active());
    add_prior(problem, model);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      add_estimate(problem, k, seen[k]);
      if (k > 0) add_motion(problem, model, k - 1, seen[k].seconds - seen[k - 1].seconds);
    }
    const double step = problem.solve();
    result = {problem.nodes(), problem.last_covariance()};
    if (step < converged) break;
  }
  return result;
}

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
    const Matrix6d covariance = random_covariance(scale, apart, random);
    all.push_back({std::round(t * 1e9) / 1e9,
                   moved(truth.at(t), root(covariance) * normal<6>(random)), covariance});
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
    const Matrix3d expected = smoothed.last_covariance.topLeftCorner<3, 3>();
    const Matrix3d off = pose.covariance.topLeftCorner<3, 3>() - expected;
    EXPECT_LT(off.norm(), linear_variance_tolerance * expected.norm());
  }
}

PoseTrackerConfig with_motion(Motion motion) {
  PoseTrackerConfig config{.motion = motion};
  if (motion == Motion::along_direction) config.direction = {1, 0, 0};
  return config;
}

INSTANTIATE_TEST_SUITE_P(Motions, LinearMotion,
                         testing::Values(with_motion(Motion::constant_twist),
                                         with_motion(Motion::constant_velocity),
                                         with_motion(Motion::along_direction),
                                         PoseTrackerConfig{.motion = Motion::along_direction,
                                                           .direction = {1, 0, 0},
                                                           .speed = 0.3},
                                         with_motion(Motion::still)));

TEST(PointSmoother, FilterIsItsEnd) {
  auto random = seeded_random(422);
  const PointTrackerConfig config{.motion = PointMotion::constant_velocity, .gate = 1e6};
  PointTracker tracker(config);
  PoseTrackerConfig twin = with_motion(Motion::constant_velocity);
  twin.acceleration = config.acceleration;
  twin.speed_sigma = config.speed_sigma;
  const auto seen = seen_poses(sigmas(0.01, 0.03), true, random);
  for (const auto& one : seen) {
    const Matrix3d covariance = one.covariance.topLeftCorner<3, 3>();
    tracker.update({stamp_at(one.seconds), one.pose.translation(), covariance}, Verdict::visible);
  }
  const auto point = tracker.at(stamp_at(seen.back().seconds));
  const auto smoothed = smooth(model_of(twin), seen);
  EXPECT_LT((point.position - smoothed.nodes.back().pose.translation()).norm(), linear_tolerance);
  EXPECT_LT((point.velocity - smoothed.nodes.back().twist.head<3>()).norm(), 10 * linear_tolerance);
  const Matrix3d expected = smoothed.last_covariance.topLeftCorner<3, 3>();
  EXPECT_LT((point.covariance - expected).norm(), linear_variance_tolerance * expected.norm());
}

}  // namespace
}  // namespace penumbra::test
