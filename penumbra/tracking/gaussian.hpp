// SPDX-License-Identifier: Apache-2.0
// Of any size, so that Eigen's templates are compiled once, not for each size.
#pragma once

#include <Eigen/Core>

namespace penumbra::detail {

/// Returns the squared Mahalanobis distance r^T S^-1 r; infinite if S is not positive definite.
[[nodiscard]] double squared_distance(const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& residual);

/// Returns a covariance without the asymmetry of rounding.
[[nodiscard]] Eigen::MatrixXd symmetric(const Eigen::MatrixXd& matrix);

/// Corrects a Kalman filter by a measurement of the state's first components, as many as `residual`
/// has. Returns the change of the state, and updates the covariance in Joseph's form, which stays
/// positive semi-definite for any gain (Bucy and Joseph, "Filtering for Stochastic Processes with
/// Applications to Guidance", 1968; Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to
/// Tracking and Navigation", 2001, section 5.2).
[[nodiscard]] Eigen::VectorXd kalman_correction(Eigen::Ref<Eigen::MatrixXd> covariance,
                                                const Eigen::MatrixXd& noise,
                                                const Eigen::VectorXd& residual);

/// Returns whether a matrix is finite, symmetric and positive definite.
[[nodiscard]] bool is_covariance(const Eigen::MatrixXd& matrix);

}  // namespace penumbra::detail
