// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace penumbra::detail {

// Rotation vectors: axis times angle, radians. Notation and formulas: Sola, Deray, Atchuthan, "A
// micro Lie theory for state estimation in robotics", arXiv 1812.01537 (2018), appendix on SO(3).

[[nodiscard]] Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// Exp: the rotation by a vector.
[[nodiscard]] Eigen::Quaterniond rotation_of(const Eigen::Vector3d& vector);

/// Log: the vector of a rotation, at most pi long.
[[nodiscard]] Eigen::Vector3d vector_of(const Eigen::Quaterniond& rotation);

/// The left Jacobian J: Exp(v + d) = Exp(J(v) d) Exp(v) for small d.
[[nodiscard]] Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& vector);

/// Covariance that white angular acceleration of spectral density 1 adds over time to an error
/// (d, e) of orientation and angular velocity w, Exp(d) in the fixed frame: d' = w x d + e, so that
/// an error of s seconds ago counts with Exp(w s) and s J(w s). Exact for constant w.
struct AngularNoise {
  Eigen::Matrix3d angle;  ///< of d: the integral of s^2 J J^T
  Eigen::Matrix3d mixed;  ///< of d with e: the integral of s J; that of e is the time
};
[[nodiscard]] AngularNoise angular_noise(const Eigen::Vector3d& velocity, double seconds);

}  // namespace penumbra::detail
