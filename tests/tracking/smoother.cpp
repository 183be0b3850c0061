// SPDX-License-Identifier: Apache-2.0
#include "smoother.hpp"

#include "../support/algebra.hpp"
#include "tracks.hpp"

#include <functional>

#include <Eigen/Cholesky>
#include <unsupported/Eigen/MatrixFunctions>

namespace penumbra::test {
namespace {

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
      const std::size_t node = first + static_cast<std::size_t>(j / n);
      const Node kept = nodes_[node];
      Vector12d by = Vector12d::Zero();
      by[active_[static_cast<std::size_t>(j % n)]] = step;
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
      for (std::size_t j = 0; j < active_.size(); ++j) {
        by[active_[j]] = step[static_cast<Eigen::Index>(i * active_.size() + j)];
      }
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
  for (int i = 0; i < 6; ++i) {
    if (model.twist_variance[i] > 0) known.push_back(i);
  }
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

}  // namespace

std::vector<int> MotionModel::active() const {
  std::vector<int> indices{0, 1, 2, 3, 4, 5};
  for (int i = 0; i < 6; ++i) {
    if (twist_variance[i] > 0 || density[6 + i] > 0) indices.push_back(6 + i);
  }
  return indices;
}

Matrix12d MotionModel::noise(const Eigen::Vector3d& turning, double seconds) const {
  Matrix12d dynamics = Matrix12d::Zero();
  dynamics.topRightCorner<6, 6>().setIdentity();
  dynamics.block<3, 3>(3, 3) << 0, -turning.z(), turning.y(), turning.z(), 0, -turning.x(),
      -turning.y(), turning.x(), 0;
  Matrix joint = Matrix::Zero(24, 24);
  joint.topLeftCorner<12, 12>() = -dynamics;
  joint.topRightCorner<12, 12>() = density.asDiagonal();
  joint.bottomRightCorner<12, 12>() = dynamics.transpose();
  const Matrix exponential = (seconds * joint).exp();
  const Matrix12d result =
      exponential.bottomRightCorner<12, 12>().transpose() * exponential.topRightCorner<12, 12>();
  return (result + result.transpose()) / 2;
}

Node MotionModel::carried_on(const Node& node, double seconds) {
  const Eigen::Vector3d turned = seconds * node.twist.tail<3>();
  return {pose_of(node.pose.translation() + seconds * node.twist.head<3>(),
                  turn(turned) * node.pose.linear()),
          node.twist};
}

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

}  // namespace penumbra::test
