// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>

#include <penumbra/calibration/dense.hpp>

namespace penumbra::dense {

Eigen::VectorXd solve(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& right) {
  return symmetric.ldlt().solve(right);
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& symmetric) {
  return symmetric.ldlt().solve(Eigen::MatrixXd::Identity(symmetric.rows(), symmetric.cols()));
}

double squared_sigmas(const Eigen::VectorXd& value, const Eigen::MatrixXd& symmetric) {
  return value.dot(solve(symmetric, value));
}

Eigen::MatrixXd sandwich(const Eigen::MatrixXd& outer, const Eigen::MatrixXd& inner) {
  return outer * inner * outer;
}

Eigen::MatrixXd lower_factor(const Eigen::MatrixXd& symmetric) { return symmetric.llt().matrixL(); }

PrincipalAxes principal_axes(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace penumbra::dense
