// SPDX-License-Identifier: Apache-2.0
// Decompositions of symmetric matrices of any size. They stand in one source: Eigen compiles each
// for each size and expression anew, which took a minute.
#pragma once

#include <Eigen/Core>

namespace penumbra::dense {

/// Returns x of `symmetric` x = `right`.
[[nodiscard]] Eigen::VectorXd solve(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& right);
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& symmetric);

/// Returns value^T symmetric^-1 value: of a covariance, the square of the standard deviations that
/// the value is from 0.
[[nodiscard]] double squared_sigmas(const Eigen::VectorXd& value, const Eigen::MatrixXd& symmetric);

/// Returns outer inner outer.
[[nodiscard]] Eigen::MatrixXd sandwich(const Eigen::MatrixXd& outer, const Eigen::MatrixXd& inner);

/// Returns the lower triangular L of L L^T, Cholesky's factor.
[[nodiscard]] Eigen::MatrixXd lower_factor(const Eigen::MatrixXd& symmetric);

/// The eigenvalues, the least first, and their eigenvectors as columns.
struct PrincipalAxes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric);

}  // namespace penumbra::dense
