// SPDX-License-Identifier: Apache-2.0
// Covariance algebra of dynamic size, compiled once: fixed sizes cost seconds in each file.
#pragma once

#include <Eigen/Core>

namespace penumbra::test {

[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix);

/// The lower triangle L of covariance = L L^T.
[[nodiscard]] Eigen::MatrixXd root(const Eigen::MatrixXd& covariance);

/// The squared Mahalanobis distance.
[[nodiscard]] double squared_sigmas(const Eigen::VectorXd& error,
                                    const Eigen::MatrixXd& covariance);

/// Of a symmetric matrix.
[[nodiscard]] double least_eigenvalue(const Eigen::MatrixXd& matrix);

}  // namespace penumbra::test
