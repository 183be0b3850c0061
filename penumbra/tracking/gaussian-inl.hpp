// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <penumbra/tracking/trackers.hpp>

namespace penumbra::detail {

/// Returns the squared Mahalanobis distance r^T S^-1 r; infinite if S is not positive definite.
template <int n>
[[nodiscard]] double squared_distance(const Eigen::Matrix<double, n, n>& covariance,
                                      const Eigen::Matrix<double, n, 1>& residual) {
  const Eigen::LLT<Eigen::Matrix<double, n, n>> factor(covariance);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return factor.matrixL().solve(residual).squaredNorm();
}

/// Returns a covariance without the asymmetry of rounding.
template <int n>
[[nodiscard]] Eigen::Matrix<double, n, n> symmetric(const Eigen::Matrix<double, n, n>& matrix) {
  return (matrix + matrix.transpose()) / 2;
}

/// Corrects a Kalman filter by a measurement of the first n of m components. Returns the change of
/// the state, and updates the covariance in Joseph's form, which stays positive semi-definite for
/// any gain (Bucy and Joseph, "Filtering for Stochastic Processes with
/// Applications to Guidance", 1968; Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to
/// Tracking and Navigation", 2001, section 5.2).
template <int m, int n>
[[nodiscard]] Eigen::Matrix<double, m, 1> kalman_correction(
    Eigen::Matrix<double, m, m>& covariance, const Eigen::Matrix<double, n, n>& noise,
    const Eigen::Matrix<double, n, 1>& residual) {
  const Eigen::Matrix<double, n, n> total = covariance.template topLeftCorner<n, n>() + noise;
  const Eigen::Matrix<double, m, n> gain =
      total.llt().solve(covariance.template topRows<n>()).transpose();
  // (I - K H) P (I - K H)^T, where H picks the first n components.
  Eigen::Matrix<double, m, m> kept = covariance - gain * covariance.template topRows<n>();
  kept -= (kept.template leftCols<n>() * gain.transpose()).eval();
  covariance = symmetric<m>(kept + gain * noise * gain.transpose());
  return gain * residual;
}

/// Returns whether a matrix is finite, symmetric and positive definite.
template <int n>
[[nodiscard]] bool is_covariance(const Eigen::Matrix<double, n, n>& matrix) {
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
