// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <Eigen/Cholesky>

#include <penumbra/tracking/gaussian.hpp>
#include <penumbra/tracking/trackers.hpp>

namespace penumbra::detail {

double squared_distance(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residual) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return residual.dot(factor.solve(residual));
}

Eigen::MatrixXd symmetric(const Eigen::MatrixXd& matrix) {
  return (matrix + matrix.transpose()) / 2;
}

Eigen::VectorXd kalman_correction(Eigen::Ref<Eigen::MatrixXd> covariance,
                                  const Eigen::MatrixXd& noise, const Eigen::VectorXd& residual) {
  const Eigen::Index n = residual.size();
  const Eigen::MatrixXd total = covariance.topLeftCorner(n, n) + noise;
  const Eigen::MatrixXd rows = covariance.topRows(n);
  const Eigen::MatrixXd gain = total.llt().solve(rows).transpose();
  // (I - K H) P (I - K H)^T, where H picks the first n components.
  Eigen::MatrixXd kept = covariance - gain * rows;
  kept -= (kept.leftCols(n) * gain.transpose()).eval();
  covariance = symmetric(kept + gain * noise * gain.transpose());
  return gain * residual;
}

bool is_covariance(const Eigen::MatrixXd& matrix) {
  constexpr double rounding = 1e-9;  // of the largest entry: what symmetry may be off by
  constexpr double slack = 1 + 1e-9;
  if (!matrix.allFinite()) return false;
  const double size = matrix.cwiseAbs().maxCoeff();
  return matrix.diagonal().minCoeff() * slack >= positive.least * positive.least &&
         size <= slack * positive.most * positive.most &&
         (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= rounding * size &&
         matrix.llt().info() == Eigen::Success;
}

}  // namespace penumbra::detail
